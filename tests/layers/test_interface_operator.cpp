#include "host/layers/rough/interface_operator.h"
#include "tests/support/private_cache.h"

#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include <cmath>
#include <fstream>

#include <sys/wait.h>
#include <unistd.h>

using namespace reradiant;

namespace {

const test::PrivateCache cache("interface-operator");

double largest_loss(const InterfaceOperator& op) {
    const Eigen::VectorXd sums = op.exchange.colwise().sum().transpose();
    return (sums.array() / op.etendue().array() - 1.0).abs().maxCoeff();
}

} // namespace

TEST(InterfaceOperator, Case29MultipleScatteringIsConservingAndReciprocalTogether) {
    for (const Distribution d : {Distribution::Blinn, Distribution::Beckmann, Distribution::Ggx}) {
        const auto op = interface_operator({1.5, d, 0.4, Scattering::Multiple});
        EXPECT_LT(largest_loss(*op), 1e-11); // the scaling stops at 1e-14 a step
        EXPECT_EQ((op->exchange - op->exchange.transpose()).cwiseAbs().maxCoeff(), 0.0);
        EXPECT_GE(op->exchange.minCoeff(), 0.0);
    }
}

TEST(InterfaceOperator, Case29SingleScatteringIsReciprocalAndLoses) {
    const auto op = interface_operator({1.5, Distribution::Ggx, 0.4, Scattering::Single});
    EXPECT_LT((op->exchange - op->exchange.transpose()).cwiseAbs().maxCoeff(), 1e-15);
    const Eigen::VectorXd sums = op->exchange.colwise().sum().transpose();
    EXPECT_LE((sums.array() / op->etendue().array()).maxCoeff(), 1.0 + 5e-3); // sampling
    EXPECT_GT(largest_loss(*op), 0.05);
}

TEST(InterfaceOperator, IndicesBetweenTheNodesAreInterpolated) {
    const RoughInterface between{1.5234, Distribution::Ggx, 0.4, Scattering::Multiple};
    const auto interpolated = interface_operator(between);
    const InterfaceOperator direct = compute_interface_operator(between);
    EXPECT_LT(largest_loss(*interpolated), 1e-11);
    const Eigen::Index n = interface_cells;
    // both carry the sampling error of their own walks
    const auto transmitted = [&](const InterfaceOperator& op) {
        return op.exchange.bottomLeftCorner(n, n).sum();
    };
    EXPECT_NEAR(transmitted(*interpolated), transmitted(direct), 1e-3);
}

TEST(InterfaceOperator, DamagedCacheFilesAreComputedAgain) {
    // in a child process, which has no operators in memory
    const auto sum_in_child = [](const RoughInterface& interface,
                                 const std::filesystem::path& out) {
        const pid_t child = fork();
        if (child == 0) {
            std::ofstream(out) << std::hexfloat << interface_operator(interface)->exchange.sum();
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        std::string text;
        std::ifstream(out) >> text;
        return text;
    };
    const test::PrivateCache own("interface-damage");
    const RoughInterface interface { 1.7, Distribution::Ggx, 0.7, Scattering::Single };
    const std::filesystem::path out = own.folder().string() + ".txt";
    // computed without threads: those of the parent do not exist in a forked child
    const tbb::global_control serial(tbb::global_control::max_allowed_parallelism, 1);
    const std::string first = sum_in_child(interface, out);
    EXPECT_FALSE(first.empty());
    const auto file = std::filesystem::directory_iterator(own.folder() / "interfaces")->path();
    const auto size = std::filesystem::file_size(file);
    EXPECT_EQ(sum_in_child(interface, out), first) << "read back";
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(5000).put('\x55');
    EXPECT_EQ(sum_in_child(interface, out), first) << "one byte changed";
    std::filesystem::resize_file(file, size / 2);
    EXPECT_EQ(sum_in_child(interface, out), first) << "truncated";
    EXPECT_EQ(std::filesystem::file_size(file), size) << "written again";
    std::filesystem::remove(out);
    setenv("RERADIANT_CACHE", cache.folder().c_str(), 1);
}

TEST(InterfaceOperator, UnwritableCacheIsNoError) {
    const char* const old = std::getenv("RERADIANT_CACHE");
    const std::string saved = old != nullptr ? old : "";
    setenv("RERADIANT_CACHE", "/proc/nowhere", 1);
    EXPECT_NO_THROW(interface_operator({1.3, Distribution::Ggx, 0.9, Scattering::Single}));
    setenv("RERADIANT_CACHE", saved.c_str(), 1);
}

TEST(InterfaceOperator, SymmetricScalingReachesItsTarget) {
    Eigen::MatrixXd m(3, 3);
    m << 4, 1, 2, 1, 3, 1, 2, 1, 5;
    const Eigen::VectorXd target = Eigen::Vector3d(1, 2, 3);
    scale_symmetric(m, target);
    EXPECT_LT((m.colwise().sum().transpose() - target).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((m - m.transpose()).cwiseAbs().maxCoeff(), 1e-15);
}
