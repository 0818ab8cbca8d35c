#include "tools/python/call.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace py = pybind11;

namespace reradiant::python {

namespace {

/// Ctrl-C is noticed at most this much later; a wake-up costs microseconds.
constexpr auto signal_period = std::chrono::milliseconds(50);

struct LogMessage {
    int level;
    std::string text;
};

/// Keeps messages until a thread that holds the GIL takes them: the library logs from any thread.
class MessageStore : public spdlog::sinks::base_sink<std::mutex> {
public:
    std::vector<LogMessage> take() {
        const std::lock_guard<std::mutex> lock(mutex_);
        return std::exchange(messages_, {});
    }

protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
        // Python's levels are multiples of ten: info is 20, warning 30, error 40.
        messages_.push_back({10 * static_cast<int>(message.level),
                             std::string(message.payload.data(), message.payload.size())});
    }
    void flush_() override {}

private:
    std::vector<LogMessage> messages_;
};

std::shared_ptr<MessageStore>& message_store() {
    static std::shared_ptr<MessageStore> store = std::make_shared<MessageStore>();
    return store;
}

/// A `Worker` runs work on a thread of its own and can wait for its end.
class Worker {
public:
    explicit Worker(const std::function<void(StopFlag)>& work)
        : thread_([this, &work] {
              std::exception_ptr thrown;
              try {
                  work(&stop_);
              } catch (...) {
                  thrown = std::current_exception();
              }
              const std::lock_guard<std::mutex> lock(mutex_);
              thrown_ = thrown;
              done_ = true;
              ended_.notify_one();
          }) {}
    ~Worker() { thread_.join(); }

    /// True when the work ended within one period. Without the GIL.
    bool wait() {
        std::unique_lock<std::mutex> lock(mutex_);
        return ended_.wait_for(lock, signal_period, [this] { return done_; });
    }
    void stop() { stop_ = true; }
    std::exception_ptr thrown() const { return thrown_; }

private:
    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::condition_variable ended_;
    bool done_ = false;
    std::exception_ptr thrown_;
    std::thread thread_; // last: starts when the rest is there
};

} // namespace

void install_log() {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("reradiant", message_store()));
}

void pass_messages_on() {
    const std::vector<LogMessage> messages = message_store()->take();
    if (messages.empty())
        return;
    const py::object logger = py::module_::import("logging").attr("getLogger")("reradiant");
    for (const LogMessage& message : messages)
        logger.attr("log")(message.level, "%s", message.text);
}

void run_interruptible(const std::function<void(StopFlag)>& work) {
    std::optional<py::error_already_set> signal;
    std::exception_ptr thrown;
    {
        const py::gil_scoped_release released;
        Worker worker(work);
        while (!worker.wait()) {
            const py::gil_scoped_acquire acquired;
            if (PyErr_CheckSignals() != 0) {
                signal.emplace();
                worker.stop();
            }
        }
        thrown = worker.thrown();
    }
    pass_messages_on();
    if (signal)
        throw *signal;
    if (thrown)
        std::rethrow_exception(thrown);
}

} // namespace reradiant::python
