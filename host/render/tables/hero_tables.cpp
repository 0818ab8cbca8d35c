#include "host/render/tables/hero_tables.h"

#include <algorithm>

namespace reradiant {

namespace {

/// Share of the samples that keep their wavelength: of a lane that reflects by a specular lobe
/// alone as of one that re-radiates alone.
constexpr double least_unshifted = 0.2;
/// Light that every excitation is credited with beside what lamps send, in units of their mean:
/// light that was re-radiated before comes where lamps may have nothing.
constexpr double indirect_light = 0.1;

class ShiftTables {
public:
    ShiftTables(const WavelengthPlan& plan, SceneTables& out)
        : out_(out), phases_(static_cast<std::size_t>(plan.phases)), lanes_(plan.lanes.size()),
          padded_(static_cast<std::size_t>(plan.padded_lanes())) {
        for (std::size_t phase = 0; phase < phases_; ++phase)
            light_.push_back(light_at(phase));
    }

    std::uint32_t append(const MaterialRecord& material) {
        const auto offset = static_cast<std::uint32_t>(out_.tables.size());
        for (std::size_t phase = 0; phase < phases_; ++phase)
            for (std::size_t o = 0; o < padded_; ++o)
                append_row(o, o < lanes_ ? row(material, phase, o) : std::vector<double>());
        return offset;
    }

private:
    double at(std::size_t offset) const { return static_cast<double>(out_.tables[offset]); }

    /// Spectra of all lights, each over its mean, so that a dim one is not missed.
    std::vector<double> light_at(std::size_t phase) const {
        std::vector<double> light(lanes_, indirect_light);
        for (std::size_t l = 0; l < out_.lights.size(); ++l) {
            const std::size_t colours = l == out_.image.light ? 3 : 1;
            std::vector<double> spectrum(lanes_, 0.0);
            double mean = 0.0;
            for (std::size_t i = 0; i < colours * lanes_; ++i) {
                const double value = at(out_.lights[l].spectrum +
                                        (i / lanes_ * phases_ + phase) * padded_ + i % lanes_);
                spectrum[i % lanes_] += value;
                mean += value / static_cast<double>(lanes_);
            }
            for (std::size_t i = 0; i < lanes_ && mean > 0.0; ++i)
                light[i] += spectrum[i] / mean;
        }
        return light;
    }

    /// Returns what each excitation lane adds to emission lane `o`: the substrate's operator times
    /// the light.
    std::vector<double> row(const MaterialRecord& material, std::size_t phase,
                            std::size_t o) const {
        std::vector<double> weights(lanes_, 0.0);
        const std::size_t rank = material.rank;
        const std::size_t factors = material.factors + phase * 2 * rank * padded_;
        for (std::size_t k = 0; k < rank; ++k)
            for (std::size_t i = 0; i < o; ++i)
                weights[i] +=
                    at(factors + k * padded_ + o) * at(factors + (rank + k) * padded_ + i);
        for (std::size_t i = 0; material.dense != NO_INDEX && i < lanes_; ++i)
            weights[i] += at(material.dense + (phase * padded_ + i) * padded_ + o);
        weights[o] += at(material.diagonal + phase * padded_ + o);
        for (std::size_t i = 0; i < lanes_; ++i)
            weights[i] = std::max(0.0, weights[i]) * light_[phase][i];
        return weights;
    }

    /// Cumulative; 1 from the last lane on that can be chosen. A row without weights never shifts.
    void append_row(std::size_t o, const std::vector<double>& weights) {
        double sum = 0.0;
        for (const double weight : weights)
            sum += weight;
        double cumulative = 0.0;
        for (std::size_t i = 0; i < padded_; ++i) {
            if (i < weights.size() && sum > 0.0)
                cumulative += (1.0 - least_unshifted) * weights[i] / sum;
            if (i == o)
                cumulative += sum > 0.0 ? least_unshifted : 1.0;
            const bool is_last = cumulative > 1.0 - 1e-12;
            out_.tables.push_back(is_last ? 1.0f : static_cast<float>(cumulative));
        }
    }

    SceneTables& out_;
    std::size_t phases_, lanes_, padded_;
    std::vector<std::vector<double>> light_; ///< [phase][lane]
};

} // namespace

void append_hero(const WavelengthPlan& plan, SceneTables& tables) {
    ShiftTables shifts(plan, tables);
    for (MaterialRecord& material : tables.materials) {
        const bool shifting = material.rank > 0 || material.dense != NO_INDEX;
        material.shift = shifting ? shifts.append(material) : NO_INDEX;
    }
}

} // namespace reradiant
