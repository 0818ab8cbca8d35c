#include "host/cluster/cluster.h"
#include "host/cluster/launcher.h"
#include "reradiant/error.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <exception>
#include <mutex>
#include <stop_token>
#include <thread>

namespace reradiant {

namespace {

using namespace std::chrono_literals;

constexpr int report_tag = 1, task_tag = 2, text_tag = 3;
constexpr auto longest_nap = 1000us;
/// So long a member that fails waits for the leader, who fails alike, to say so for all.
constexpr auto patience = 3s;

/// Waits without keeping a core busy: members may share one. MPI's own waiting does not sleep.
template <typename Ready>
void nap_until(const Ready& ready) {
    for (auto nap = 20us; !ready(); nap = std::min<std::chrono::microseconds>(2 * nap, longest_nap))
        std::this_thread::sleep_for(nap);
}

void wait_for(MPI_Request request) {
    nap_until([&] {
        int done = 0;
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        return done != 0;
    });
}

/// Reports and tasks cross as the bytes they are: all members run the same build.
template <typename Message>
void send_to(int rank, int tag, const Message& message) {
    MPI_Send(&message, sizeof message, MPI_BYTE, rank, tag, MPI_COMM_WORLD);
}
template <typename Message>
Message receive_from(int rank, int tag) {
    Message message;
    MPI_Recv(&message, sizeof message, MPI_BYTE, rank, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
}

using NextTask = std::function<TeamTask(const TeamReport&)>;
using DoTask = std::function<TeamReport(const TeamTask&)>;

/// Works through tasks that `next` gives.
void work_through(const NextTask& next, const DoTask& work) {
    TeamReport report;
    for (TeamTask task = next(report); task.count > 0; task = next(report))
        report = work(task);
}

/// Answers the others until each of them was told that there is no more.
void serve(const NextTask& next, int others, const std::stop_token& stop) {
    while (others > 0 && !stop.stop_requested()) {
        int waiting = 0;
        MPI_Status status;
        nap_until([&] {
            MPI_Iprobe(MPI_ANY_SOURCE, report_tag, MPI_COMM_WORLD, &waiting, &status);
            return waiting != 0 || stop.stop_requested();
        });
        if (waiting == 0)
            return;
        const auto report = receive_from<TeamReport>(status.MPI_SOURCE, report_tag);
        const TeamTask task = report.leaves ? TeamTask{} : next(report);
        send_to(status.MPI_SOURCE, task_tag, task);
        if (task.count == 0)
            --others;
    }
}

class MpiTeam : public Team {
public:
    MpiTeam() {
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
        MPI_Comm on_host;
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &on_host);
        MPI_Comm_rank(on_host, &rank_on_host_);
        MPI_Comm_size(on_host, &size_on_host_);
        MPI_Comm_free(&on_host);
    }
    ~MpiTeam() override {
        // With an error on its way the others do not come here: fail_in_cluster ends them.
        if (std::uncaught_exceptions() == 0)
            MPI_Finalize();
    }
    MpiTeam(const MpiTeam&) = delete;
    MpiTeam& operator=(const MpiTeam&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int size_on_host() const override { return size_on_host_; }
    int rank_on_host() const override { return rank_on_host_; }

    void share_tasks(const NextTask& next, const DoTask& work, bool takes_part) override {
        if (!leads()) {
            const NextTask ask_leader = [&](TeamReport report) {
                report.leaves = !takes_part;
                send_to(0, report_tag, report);
                await(0, task_tag);
                return receive_from<TeamTask>(0, task_tag);
            };
            work_through(ask_leader, work);
            return;
        }
        std::mutex mutex;
        const NextTask one_at_a_time = [&](const TeamReport& report) {
            const std::lock_guard lock(mutex);
            return next(report);
        };
        // MPI is this thread's alone until it is joined (MPI_THREAD_SERIALIZED); work() calls none.
        // When work() throws, the thread is stopped and joined on the way out.
        std::jthread server(
            [&](const std::stop_token& stop) { serve(one_at_a_time, size_ - 1, stop); });
        work_through(one_at_a_time, work);
        server.join();
    }

    void add_at_leader(std::span<double> values) override {
        meet();
        for (std::size_t first = 0; first < values.size(); first += INT_MAX) {
            const auto count =
                static_cast<int>(std::min<std::size_t>(values.size() - first, INT_MAX));
            double* const part = &values[first];
            MPI_Reduce(leads() ? MPI_IN_PLACE : part, part, count, MPI_DOUBLE, MPI_SUM, 0,
                       MPI_COMM_WORLD);
        }
    }

    std::uint64_t from_leader(std::uint64_t value) override {
        MPI_Request request;
        MPI_Ibcast(&value, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, &request);
        wait_for(request);
        return value;
    }

    std::vector<std::string> gather(const std::string& text) override {
        if (!leads()) {
            MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, 0, text_tag,
                     MPI_COMM_WORLD);
            return {};
        }
        std::vector<std::string> texts{text};
        for (int rank = 1; rank < size_; ++rank) {
            int length = 0;
            const MPI_Status status = await(rank, text_tag);
            MPI_Get_count(&status, MPI_CHAR, &length);
            texts.emplace_back(static_cast<std::size_t>(length), ' ');
            MPI_Recv(texts.back().data(), length, MPI_CHAR, rank, text_tag, MPI_COMM_WORLD,
                     MPI_STATUS_IGNORE);
        }
        return texts;
    }

private:
    static MPI_Status await(int rank, int tag) {
        MPI_Status status;
        nap_until([&] {
            int waiting = 0;
            MPI_Iprobe(rank, tag, MPI_COMM_WORLD, &waiting, &status);
            return waiting != 0;
        });
        return status;
    }

    /// Until all are here: what follows is quick, and MPI may wait in its own way.
    static void meet() {
        MPI_Request request;
        MPI_Ibarrier(MPI_COMM_WORLD, &request);
        wait_for(request);
    }

    int rank_ = 0, size_ = 1, rank_on_host_ = 0, size_on_host_ = 1;
};

} // namespace

std::unique_ptr<Team> join_cluster() {
    if (!is_launched())
        return nullptr;
    int provided = 0, size = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (size > 1 && provided < MPI_THREAD_SERIALIZED)
        throw_runtime_error("this MPI allows one thread only",
                            "use one with MPI_THREAD_SERIALIZED");
    if (size > 1)
        return std::make_unique<MpiTeam>();
    MPI_Finalize();
    return nullptr;
}

void fail_in_cluster(int code, const std::string& message) {
    const int rank = launched_rank();
    if (rank > 0)
        std::this_thread::sleep_for(patience);
    fmt::print(stderr, "{}{}\n", rank > 0 ? fmt::format("rank {}: ", rank) : "", message);
    int joined = 0, left = 0;
    MPI_Initialized(&joined);
    MPI_Finalized(&left);
    if (joined != 0 && left == 0)
        MPI_Abort(MPI_COMM_WORLD, code);
}

std::string mpi_version() {
    char text[MPI_MAX_LIBRARY_VERSION_STRING];
    int length = 0;
    MPI_Get_library_version(text, &length); // allowed before MPI_Init
    const std::string version(text, static_cast<std::size_t>(length));
    return version.substr(0, version.find_first_of(",\n"));
}

} // namespace reradiant
