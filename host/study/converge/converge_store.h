#pragma once

#include "host/study/converge/converge.h"

#include <nlohmann/json.hpp>

#include <optional>

namespace reradiant {

/// A row, an estimate and a curve as JSON; numbers that are not finite are null.
nlohmann::ordered_json curve_json(const ErrorCurve& curve);
nlohmann::ordered_json estimate_json(const RelmseEstimate& estimate);
RelmseEstimate estimate_from_json(const nlohmann::ordered_json& json);

/// Keeps a finished method as methods/NAME.json and methods/NAME.exr beneath `folder`. `identity`
/// is what it depends on besides its name.
void keep_method(const std::filesystem::path& folder, const std::string& identity,
                 const MethodResult& result);
/// Returns a method as an earlier run kept it; nothing when there is none, when it is of another
/// identity, or when its files are damaged.
std::optional<MethodResult> kept_method(const std::filesystem::path& folder,
                                        const std::string& identity, const RenderMethod& method);

/// Returns the file that keep_method writes a method's image to.
std::filesystem::path method_image(const std::filesystem::path& folder, const RenderMethod& method);

/// Keeps the rows of a method that is not finished as methods/NAME.rows.json; keep_method removes
/// them. kept_rows: none when there are none or they are of another identity.
void keep_rows(const std::filesystem::path& folder, const std::string& identity,
               const ErrorCurve& curve);
std::vector<CurveRow> kept_rows(const std::filesystem::path& folder, const std::string& identity,
                                const RenderMethod& method);

/// Keeps the reference that was rendered as reference.exr beneath `folder`.
void keep_reference(const std::filesystem::path& folder, Reference& reference);
/// Returns the reference that an earlier run kept, if it is there, whole and of this identity.
std::optional<Reference> kept_reference(const std::filesystem::path& folder,
                                        const std::string& identity);

/// curve.csv, a line for each point of each method.
void write_curves_csv(const std::filesystem::path& file, const ConvergeResult& result);
/// curve.json: the scene, the reference, and of each method its fits and rows.
nlohmann::ordered_json converge_json(const ConvergeResult& result, const Scene& scene,
                                     const Device& device, double time_seconds);

} // namespace reradiant
