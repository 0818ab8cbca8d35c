#include "host/render/tables/substrate_tables.h"

#include "host/spectral/colour/rgb_basis.h"
#include "kernels/scatter/oren_nayar.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

namespace reradiant {

namespace {

class SubstrateTables {
public:
    SubstrateTables(const Material& material, Model model, const MaterialOptics& optics,
                    const SubstrateOnCells& on_cells, LaneTables& lanes, MaterialRecord& record,
                    SceneTables& out)
        : substrate_(material.substrate), name_(material.name), optics_(optics),
          on_cells_(on_cells), lanes_(lanes), record_(record), out_(out),
          sigma_(substrate_.type == SubstrateType::OrenNayar ? substrate_.sigma : 0.0),
          // the first bounce stands apart where light comes back to the substrate
          has_first_(sigma_ > 0.0 && model == Model::Adding && !material.stack.layers.empty()),
          mean_albedo_(has_first_ ? kernels::oren_nayar_mean_albedo(sigma_) : 1.0) {}

    LaneOperator append() {
        const int middle = lanes_.phases() / 2;
        record_.sigma = static_cast<float>(sigma_);
        record_.diagonal = record_.factors = record_.dense = NO_INDEX;
        record_.first_diagonal = record_.first_factors = record_.first_dense = NO_INDEX;
        record_.reflectance_image = record_.image_reflectance = NO_INDEX;
        record_.separable_albedo = record_.spread_value = NO_INDEX;
        record_.rank = 0;
        if (substrate_.type == SubstrateType::Conductor || substrate_.type == SubstrateType::None) {
            record_.diagonal = lanes_.append_lanes([](int, int) { return 0.0; });
            LaneOperator black;
            black.diagonal = Eigen::VectorXd::Zero(lanes_.lanes());
            return black;
        }
        set_feedback();
        append_shape();
        if (substrate_.reflectance_image >= 0) {
            append_image();
            return operator_at(middle, mean_albedo_, true);
        }
        const std::vector<LaneOperator> rest = operators(mean_albedo_, true);
        append_operators(rest, record_.diagonal, record_.factors, record_.dense);
        if (has_first_)
            append_operators(operators(1.0, false), record_.first_diagonal, record_.first_factors,
                             record_.first_dense);
        note_fluorescence(rest.front());
        return rest[static_cast<std::size_t>(middle)];
    }

private:
    /// Under rough stacks every value takes the solution of a linear system.
    void set_feedback() {
        feedback_.resize(lanes_.lanes(), lanes_.phases());
        if (!optics_.is_spectral()) {
            feedback_.setConstant(optics_.any().internal_reflectance(sigma_));
            return;
        }
        tbb::parallel_for(0, static_cast<int>(feedback_.size()), [&](int i) {
            const int lane = i % lanes_.lanes(), phase = i / lanes_.lanes();
            feedback_(lane, phase) = optics_.at(phase, lane).internal_reflectance(sigma_);
        });
    }

    /// The kernels have a single shape of the substrate, that of the middle of the spectrum.
    void append_shape() {
        if (!has_first_)
            return;
        const auto tables =
            optics_.at(lanes_.phases() / 2, lanes_.lanes() / 2).oren_nayar_tables(sigma_);
        record_.separable_albedo = lanes_.append_numbers(tables->albedo);
        if (!tables->spread.empty())
            record_.spread_value = lanes_.append_numbers(tables->spread);
    }

    /// Returns the substrate's operator at a phase, with or without what the stack sends back to
    /// it.
    LaneOperator operator_at(int phase, double albedo, bool with_feedback) const {
        Eigen::VectorXd scale(lanes_.lanes());
        for (int lane = 0; lane < lanes_.lanes(); ++lane)
            scale(lane) = optics_.at(phase, lane).diffuse_scale();
        const Eigen::VectorXd r = (with_feedback ? 1.0 : 0.0) * feedback_.col(phase);
        return lane_operator(substrate_, on_cells_, lanes_.plan(), phase, albedo, r, scale);
    }

    std::vector<LaneOperator> operators(double albedo, bool with_feedback) const {
        std::vector<LaneOperator> all;
        for (int phase = 0; phase < lanes_.phases(); ++phase)
            all.push_back(operator_at(phase, albedo, with_feedback));
        return all;
    }

    void append_operators(const std::vector<LaneOperator>& operators, std::uint32_t& diagonal,
                          std::uint32_t& factors, std::uint32_t& dense) {
        diagonal = lanes_.append_lanes([&](int phase, int lane) {
            return operators[static_cast<std::size_t>(phase)].diagonal(lane);
        });
        if (on_cells_.fluorescence.size() == 0)
            return;
        if (on_cells_.is_factored())
            factors = append_factors(operators);
        else
            dense = append_dense(operators);
    }

    std::uint32_t append_factors(const std::vector<LaneOperator>& operators) {
        const std::uint32_t offset = lanes_.here();
        const Eigen::Index rank = operators.front().emission.cols();
        record_.rank = static_cast<std::uint32_t>(rank);
        for (const LaneOperator& op : operators)
            for (const Eigen::MatrixXd* factor : {&op.emission, &op.excitation})
                for (Eigen::Index k = 0; k < rank; ++k)
                    for (int lane = 0; lane < lanes_.padded_lanes(); ++lane)
                        lanes_.append(lane < lanes_.lanes() ? (*factor)(lane, k) : 0.0);
        return offset;
    }

    std::uint32_t append_dense(const std::vector<LaneOperator>& operators) {
        const std::uint32_t offset = lanes_.here();
        const int lanes = lanes_.lanes();
        for (const LaneOperator& op : operators)
            for (int i = 0; i < lanes_.padded_lanes(); ++i)
                for (int o = 0; o < lanes_.padded_lanes(); ++o)
                    lanes_.append(i < lanes && o < lanes ? op.dense(o, i) : 0.0);
        return offset;
    }

    /// A reflectance that an image colours is put together by the kernel: the diagonal holds the
    /// factor of the substrate's operator alone.
    void append_image() {
        record_.reflectance_image = static_cast<std::uint32_t>(substrate_.reflectance_image);
        record_.diagonal = lanes_.append_lanes(
            [&](int phase, int lane) { return optics_.at(phase, lane).diffuse_scale(); });
        if (has_first_)
            record_.first_diagonal = record_.diagonal;
        record_.image_reflectance = lanes_.append_lanes(
            [&](int phase, int lane) { return mean_albedo_ * feedback_(lane, phase); });
        for (const Spectrum& primary : rgb_basis())
            lanes_.append_lanes([&](int phase, int lane) {
                const double nm = lanes_.plan().wavelength_nm(lane, phase);
                return substrate_.reflectance(nm) * primary(nm);
            });
    }

    void note_fluorescence(const LaneOperator& op) {
        if (on_cells_.fluorescence.size() == 0)
            return;
        if (on_cells_.is_factored()) {
            out_.notes.push_back(fmt::format(
                "material '{}': re-radiation as a sum of {} products of an emission and an "
                "excitation",
                name_, op.emission.cols()));
            return;
        }
        out_.notes.push_back(fmt::format("material '{}': re-radiation entry by entry, as it is no "
                                         "sum of few products or holds anti-Stokes emission",
                                         name_));
    }

    const Substrate& substrate_;
    const std::string& name_;
    const MaterialOptics& optics_;
    const SubstrateOnCells& on_cells_;
    LaneTables& lanes_;
    MaterialRecord& record_;
    SceneTables& out_;
    double sigma_;
    bool has_first_;
    double mean_albedo_;       ///< Em of oren_nayar_substrate.h where the first bounce stands apart
    Eigen::MatrixXd feedback_; ///< r, (lanes, phases)
};

} // namespace

LaneOperator append_substrate(const Material& material, Model model, const MaterialOptics& optics,
                              const SubstrateOnCells& on_cells, LaneTables& lanes,
                              MaterialRecord& record, SceneTables& out) {
    return SubstrateTables(material, model, optics, on_cells, lanes, record, out).append();
}

} // namespace reradiant
