#pragma once

// Names inside our spectral EXR files, used by the writer and the reader.
namespace reradiant::exr_layout {

inline constexpr const char* image_part = "image";
inline constexpr const char* statistics_part = "statistics";
inline constexpr const char* sample_count_channel = "sampleCount";
inline constexpr const char* variance_y_channel = "variance.Y";
inline constexpr const char* variance_prefix = "variance."; ///< before a band's channel name
inline constexpr const char* attribute_prefix = "reradiant:";
/// The exact grid (double): channel names are rounded to 1e-6 nm, and one band has no step.
inline constexpr const char* first_band_attribute = "reradiant:firstBandNm";
inline constexpr const char* band_step_attribute = "reradiant:bandStepNm";
/// Of a layer (reradiant/spectral_image.h): its part's name begins with the prefix.
inline constexpr const char* light_prefix = "light.";
inline constexpr const char* light_group_attribute = "reradiant:lightGroup";
inline constexpr const char* light_part_attribute = "reradiant:lightPart"; ///< whole, uv, visible
inline constexpr const char* light_range_attribute = "reradiant:lightRangeNm";
inline constexpr const char* lamp_attribute = "reradiant:lamp"; ///< means over cells of 1 nm
inline constexpr const char* quantity_attribute = "reradiant:quantity";

} // namespace reradiant::exr_layout
