#include "host/base/output_ending.h"
#include "host/base/output_file.h"
#include "reradiant/spectral_image.h"
#include "tools/python/bindings.h"
#include "tools/python/call.h"
#include "tools/python/values.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>

namespace py = pybind11;

namespace reradiant::python {

namespace {

using ImagePointer = std::shared_ptr<SpectralImage>;

/// A view of one of the image's buffers, None when it is empty: (height, width) or with bands.
template <std::vector<float> SpectralImage::*buffer, bool with_bands>
py::object buffer_view(const ImagePointer& image) {
    std::vector<float>& values = (*image).*buffer;
    if (values.empty())
        return py::none();
    std::vector<py::ssize_t> shape{image->height, image->width};
    if (with_bands)
        shape.push_back(image->bands.count);
    return view(values.data(), shape, py::cast(image));
}

ImagePointer make_image(int height, int width, const py::tuple& bands) {
    auto image = std::make_shared<SpectralImage>();
    image->height = height;
    image->width = width;
    image->bands = grid_from(bands);
    image->values.assign(static_cast<std::size_t>(height) * static_cast<std::size_t>(width) *
                             static_cast<std::size_t>(image->bands.count),
                         0.0f);
    return image;
}

DisplayOptions display_options(const std::string& ocio, const std::string& display,
                               const std::string& view_name, double exposure) {
    DisplayOptions options;
    options.ocio_config = ocio;
    options.display = display;
    options.view = view_name;
    options.exposure_ev = exposure;
    return options;
}

std::size_t write_png_file(const SpectralImage& image, const std::string& file,
                           const std::string& ocio, const std::string& display,
                           const std::string& view_name, double exposure) {
    const DisplayOptions options = display_options(ocio, display, view_name, exposure);
    check_output_file(file);
    check_output_ending(file, {".png"}, "Image.write_png", "Image.write makes an EXR");
    return interruptible([&](StopFlag) { return write_display_png(file, image, options); });
}

py::object srgb(const SpectralImage& image) {
    auto kept = std::make_unique<std::vector<float>>(
        interruptible([&](StopFlag) { return linear_srgb(image); }));
    float* const data = kept->data();
    const py::capsule owner(kept.release(),
                            [](void* vector) { delete static_cast<std::vector<float>*>(vector); });
    return view(data, {image.height, image.width, 3}, owner);
}

py::dict compare(const SpectralImage& image, const SpectralImage& reference) {
    const Comparison found =
        interruptible([&](StopFlag) { return compare_images(image, reference); });
    return py::dict(py::arg("relmse") = found.relmse, py::arg("relmse_srgb") = found.relmse_srgb,
                    py::arg("rmse") = found.rmse, py::arg("bias") = found.bias,
                    py::arg("bias_stderr") = found.bias_stderr,
                    py::arg("ciede2000") = found.ciede2000);
}

} // namespace

void bind_images(py::module_& module) {
    py::class_<SpectralImage, ImagePointer>(module, "SpectralImage")
        .def(py::init(&make_image))
        .def_static("read",
                    [](const std::string& file) {
                        return std::make_shared<SpectralImage>(
                            interruptible([&](StopFlag) { return read_spectral_exr(file); }));
                    })
        .def_property_readonly("values", &buffer_view<&SpectralImage::values, true>)
        .def_property_readonly("sample_count", &buffer_view<&SpectralImage::sample_count, false>)
        .def_property_readonly("variance_y", &buffer_view<&SpectralImage::variance_y, false>)
        .def_property_readonly("variance_bands", &buffer_view<&SpectralImage::variance_bands, true>)
        .def_property_readonly("bands",
                               [](const SpectralImage& image) { return grid_tuple(image.bands); })
        .def_readwrite("attributes", &SpectralImage::attributes)
        .def("write",
             [](const SpectralImage& image, const std::string& file, double exposure) {
                 check_output_file(file);
                 check_output_ending(file, {".exr"}, "Image.write", "Image.write_png makes a PNG");
                 run_interruptible([&](StopFlag) { write_spectral_exr(file, image, exposure); });
             })
        .def("write_png", &write_png_file)
        .def("srgb", &srgb)
        .def("compare", &compare);
}

} // namespace reradiant::python
