#include "host/fit/result/fit_summary.h"
#include "host/fit/solver/solve_journal.h"
#include "reradiant/error.h"
#include "tests/fit/fit_cases.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace reradiant;

// Fits that are stopped and go on, on several threads: the same bits as without.

namespace {

BispectralData data() {
    const ReradiationMatrix truth = true_matrix(two_fluorophores());
    return noisy_data(truth, 0.01 * stokes_peak(truth), true, 3);
}

FitResult fit(SolveJournal* journal, int threads) {
    FitSettings settings; // terms, width and smoothing by evidence: dozens of minimisations
    settings.threads = threads;
    settings.solver.journal = journal;
    return fit_reradiation(data(), settings);
}

void expect_same(const FitResult& a, const FitResult& b) {
    EXPECT_EQ(a.rank, b.rank);
    EXPECT_EQ(a.spacing_nm, b.spacing_nm);
    EXPECT_EQ(a.matrix.values, b.matrix.values);
    EXPECT_EQ(a.sigma, b.sigma);
    EXPECT_EQ(a.trace.cost, b.trace.cost);
    EXPECT_EQ(a.trace.kkt, b.trace.kkt);
}

/// Returns the journal that a fit has kept when it is stopped after `steps` steps.
nlohmann::json kept_after(int steps, int threads) {
    SolveJournal journal;
    nlohmann::json kept;
    int taken = 0;
    journal.set_after_step([&] {
        if (++taken == steps) {
            kept = journal.json();
            throw std::runtime_error("stopped");
        }
    });
    EXPECT_THROW(fit(&journal, threads), std::runtime_error);
    return kept;
}

} // namespace

TEST(SolveJournal, FitDoesNotDependOnThreads) {
    expect_same(fit(nullptr, 1), fit(nullptr, 3));
}

TEST(SolveJournal, FitGoesOnFromAnyStep) {
    SolveJournal whole_journal;
    int all = 0;
    whole_journal.set_after_step([&] { ++all; });
    const FitResult whole = fit(&whole_journal, 1);
    ASSERT_GT(all, 100);
    for (const int steps : {1, all / 2, all - 20}) {
        SolveJournal rest(kept_after(steps, 2));
        int taken = 0;
        rest.set_after_step([&] { ++taken; });
        expect_same(fit(&rest, 2), whole);
        EXPECT_LT(taken, all - steps / 2) << "steps are not taken again";
    }
}

TEST(SolveJournal, StepsOfAnotherFitAreRefused) {
    SolveJournal journal(kept_after(20, 1));
    FitSettings settings;
    settings.rank = 1;
    settings.seed = 1;
    settings.solver.journal = &journal;
    const ReradiationMatrix other = true_matrix({two_fluorophores()[1]});
    EXPECT_THROW(fit_reradiation(noisy_data(other, 0.01, true, 1), settings), Error);
}

TEST(SolveJournal, ProgressCountsAllBranchesAndStandsInTheSummaryOfAFailure) {
    const SolveProgress progress = SolveJournal(kept_after(50, 1)).progress();
    EXPECT_GE(progress.iterations, 45); // what ends a minimisation is told as a step, too
    EXPECT_LE(progress.iterations, 50);
    EXPECT_GT(progress.finished, 0);
    EXPECT_GT(progress.minimisations, progress.finished);
    const auto failed = fit_failure_summary(FitModel::Factors, "device lost", progress);
    EXPECT_EQ(failed["failure"]["stage"], "minimisation");
    EXPECT_EQ(failed["failure"]["message"], "device lost");
    EXPECT_EQ(failed["iterations"], progress.iterations);
    const auto early = fit_failure_summary(FitModel::Factors, "no stack", SolveProgress{});
    EXPECT_EQ(early["failure"]["stage"], "stack");
}

TEST(SolveJournal, DamagedStepsAreRefused) {
    nlohmann::json kept = kept_after(20, 1);
    kept["branches"][0]["solves"][0].erase("damping");
    EXPECT_THROW(SolveJournal{kept}, Error);
    EXPECT_THROW(SolveJournal{nlohmann::json::array()}, Error);
}
