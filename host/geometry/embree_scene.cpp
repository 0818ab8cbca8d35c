#include "host/geometry/embree_scene.h"

#include "host/geometry/embree_callbacks.h"
#include "reradiant/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace reradiant {

EmbreeScene::EmbreeScene(const Surfaces& surfaces) {
    device_ = rtcNewDevice(nullptr);
    check("start");
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* self, ssize_t change, bool) {
            static_cast<EmbreeScene*>(self)->bytes_ += change;
            return true;
        },
        this);
    version_ = fmt::format("Embree {}.{}.{}",
                           rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                           rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION_MINOR),
                           rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION_PATCH));
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    attach(surfaces.spheres);
    attach(surfaces.rectangles);
    attach(surfaces.disks);
    attach(surfaces.cylinders);
    for (const OwnedMesh& mesh : surfaces.meshes)
        attach(mesh);
    rtcCommitScene(scene_);
    check("build its acceleration structure");
}

EmbreeScene::~EmbreeScene() {
    if (scene_ != nullptr)
        rtcReleaseScene(scene_);
    for (const auto& [mesh, shared] : shared_scenes_)
        rtcReleaseScene(shared);
    if (device_ != nullptr)
        rtcReleaseDevice(device_);
}

void EmbreeScene::check(const char* doing) const {
    const RTCError error = rtcGetDeviceError(device_);
    if (error != RTC_ERROR_NONE || device_ == nullptr)
        throw_runtime_error(
            fmt::format("Embree cannot {} (error {})", doing, static_cast<int>(error)),
            error == RTC_ERROR_OUT_OF_MEMORY ? "it is out of memory"
                                             : "check the installation of Embree");
}

template <typename Primitive>
void EmbreeScene::attach(const OwnedPrimitives<Primitive>& owned) {
    sources_.push_back(&owned);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(owned.primitives.size()));
    rtcSetGeometryUserData(geometry, const_cast<OwnedPrimitives<Primitive>*>(&owned));
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* a) { bounds_callback<Primitive>(a); },
        nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_callback<Primitive>);
    rtcSetGeometryOccludedFunction(geometry, occluded_callback<Primitive>);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, static_cast<unsigned int>(sources_.size() - 1));
    rtcReleaseGeometry(geometry);
}

RTCGeometry EmbreeScene::triangles_of(const MeshShape& mesh) const {
    const std::size_t vertices = mesh.positions.size() / 3;
    const std::size_t count = mesh.indices.size() / 3;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads 16 bytes at the last vertex, so it keeps its own padded copies.
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                              RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices);
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), count);
    check("take memory for a mesh");
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<float*>(positions));
    std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint32_t*>(indices));
    rtcCommitGeometry(geometry);
    return geometry;
}

RTCScene EmbreeScene::shared_scene(const MeshShape& mesh) {
    const auto [place, is_new] = shared_scenes_.try_emplace(&mesh, nullptr);
    if (is_new) {
        place->second = rtcNewScene(device_);
        rtcSetSceneFlags(place->second, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = triangles_of(mesh);
        rtcAttachGeometry(place->second, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(place->second);
    }
    return place->second;
}

void EmbreeScene::attach(const OwnedMesh& owned) {
    sources_.push_back(&owned);
    triangles_ += owned.mesh->indices.size() / 3;
    RTCGeometry geometry = nullptr;
    if (owned.placement) {
        geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, shared_scene(*owned.mesh));
        const std::array<float, 12> matrix = owned.placement->matrix();
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix.data());
        rtcCommitGeometry(geometry);
    } else {
        geometry = triangles_of(*owned.mesh);
    }
    rtcAttachGeometryByID(scene_, geometry, static_cast<unsigned int>(sources_.size() - 1));
    rtcReleaseGeometry(geometry);
}

const void* EmbreeScene::source(unsigned int geometry, unsigned int instance) const {
    return sources_[instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry];
}

} // namespace reradiant
