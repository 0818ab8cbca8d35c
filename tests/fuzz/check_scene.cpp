#include "tests/fuzz/check_scene.h"

#include "tests/fuzz/check_matrix.h"
#include "tests/fuzz/check_mesh.h"

namespace reradiant::fuzz {

namespace {

void check_shape(const SphereShape& sphere) {
    require_all_finite(sphere.centre, "centre of a sphere");
    require_finite(sphere.radius, "radius of a sphere");
}
void check_shape(const RectangleShape& rectangle) {
    for (const Vector3& part : {rectangle.centre, rectangle.edge_u, rectangle.edge_v})
        require_all_finite(part, "rectangle");
}
void check_shape(const DiskShape& disk) {
    require_all_finite(disk.centre, "centre of a disk");
    require_all_finite(disk.normal, "normal of a disk");
    require_finite(disk.radius, "radius of a disk");
}
void check_shape(const MeshShape& mesh) {
    check_mesh(mesh);
}

void check_shape(const CylinderShape& cylinder) {
    require_all_finite(cylinder.from, "end of a cylinder");
    require_all_finite(cylinder.to, "end of a cylinder");
    require_finite(cylinder.radius, "radius of a cylinder");
}
void check_shape(const MeshInstance& instance) {
    check_mesh(*instance.mesh);
    for (const double number : instance.transform)
        require_finite(number, "transform");
}

void check_conductor(const Conductor& conductor) {
    check_spectrum(conductor.ior);
    check_spectrum(conductor.kappa);
    require_finite(conductor.alpha, "roughness of a conductor");
}

void check_dye(const SlabDye& dye) {
    check_spectrum(dye.absorption);
    check_spectrum(dye.emission);
    require_finite(dye.concentration, "concentration");
    require_finite(dye.quantum_yield, "quantum yield");
    if (dye.shares)
        check_matrix(*dye.shares);
}

} // namespace

void check_spectrum(const Spectrum& spectrum) {
    for (const double nm : {300.0, 405.0, 555.0, 780.0})
        require_finite(spectrum(nm), "spectrum");
}

void check_stack(const LayerStack& stack) {
    for (const Layer& layer : stack.layers) {
        check_spectrum(layer.ior);
        check_spectrum(layer.absorption);
        check_spectrum(layer.scattering_coefficient);
        for (const double value : {layer.alpha, layer.thickness, layer.anisotropy})
            require_finite(value, "layer");
        if (layer.flakes)
            check_conductor(layer.flakes->reflector);
        for (const SlabDye& dye : layer.dyes)
            check_dye(dye);
    }
    if (stack.lower_face)
        require_finite(stack.lower_face->alpha, "roughness of a lower face");
}

void check_material(const Material& material) {
    check_stack(material.stack);
    const Substrate& substrate = material.substrate;
    check_spectrum(substrate.reflectance);
    check_conductor(substrate.conductor);
    require_finite(substrate.sigma, "sigma");
    if (substrate.matrix)
        check_matrix(*substrate.matrix);
    for (const Fluorophore& fluorophore : substrate.fluorophores) {
        check_spectrum(fluorophore.excitation);
        check_spectrum(fluorophore.emission);
        require_finite(fluorophore.quantum_yield, "quantum yield");
    }
}

void check_scene(const Scene& scene) {
    const Camera& camera = scene.camera;
    for (const Vector3& part : {camera.origin, camera.target, camera.up})
        require_all_finite(part, "camera");
    for (const double value : {camera.fov_deg, camera.lens_radius, camera.focus_distance})
        require_finite(value, "camera");
    if (scene.film.width < 1 || scene.film.height < 1)
        fail("a film without pixels");
    for (const Light& light : scene.lights) {
        check_spectrum(light_spectrum(light));
        if (const auto* rectangle = std::get_if<RectangleLight>(&light))
            check_shape(RectangleShape{rectangle->centre, rectangle->edge_u, rectangle->edge_v});
        if (const auto* mesh = std::get_if<MeshLight>(&light))
            check_mesh(mesh->mesh);
    }
    for (const Shape& shape : scene.shapes) {
        std::visit([](const auto& geometry) { check_shape(geometry); }, shape.geometry);
        if (shape.material < 0 || static_cast<std::size_t>(shape.material) >= scene.surfaces.size())
            fail("a shape of a material that is not there");
    }
    for (const Material& material : scene.materials)
        check_material(material);
}

void put_companions() {
    put("matrix.csv", "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
                      "nm,400,500\n500,0.2,0.5\n600,0.1,0.1\n");
    put("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("scene.toml", "[film]\nwidth = 8\nheight = 4\n[camera]\norigin = [0, 0, 5]\n"
                      "target = [0, 0, 0]\n[[light]]\ntype = \"environment\"\nradiance = 1\n"
                      "[[material]]\nname = \"grey\"\n[[material.layer]]\nior = 1.5\n"
                      "[material.substrate]\nreflectance = 0.5\ntype = \"lambert\"\n[[shape]]\n"
                      "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"grey\"\n");
}

} // namespace reradiant::fuzz
