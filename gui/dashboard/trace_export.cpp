#include "gui/dashboard/trace_export.hpp"

#include <sched.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "gui/base/output_folder.hpp"
#include "ipc/base/error.hpp"

namespace tact {

void write_whole_file(const std::string& path, const std::string& text) {
    const std::string partial = path + "." + std::to_string(getpid()) + ".partial";
    const auto fail = [&](const std::string& why) {
        std::error_code ignored;
        std::filesystem::remove(partial, ignored);
        throw StartupError("writing the traces to " + path, why,
                           "start the window in a writable folder with free space");
    };
    std::FILE* const opened = std::fopen(partial.c_str(), "wbe");
    if (opened == nullptr) fail(last_error());
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(opened, &std::fclose);
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0 ||
        fsync(fileno(file.get())) != 0) {
        const int error = errno;
        file.reset();
        fail(std::system_category().message(error));
    }
    file.reset();
    std::error_code error;
    std::filesystem::rename(partial, path, error);
    if (error) fail(error.message());
}

TraceExport::~TraceExport() { finish(); }

void TraceExport::finish() {
    if (thread_.joinable()) thread_.join();
}

void TraceExport::follow(TracesState& traces) {
    if (done_.exchange(false, std::memory_order_acquire)) {  // pairs with the store of the thread
        finish();
        traces.message = message_;
        traces.message_grade = grade_;
        if (grade_ == Grade::good) {
            spdlog::info("{}", message_);
        } else {
            spdlog::error("{}", message_);
        }
    }
    if (!traces.export_wanted) return;
    traces.export_wanted = false;
    if (thread_.joinable()) {
        traces.message = "an export is still being written";
        traces.message_grade = Grade::watch;
        return;
    }
    traces.message = "writing";
    traces.message_grade = Grade::unknown;
    try {
        start(traces);
    } catch (const StartupError& e) {
        traces.message = e.what();
        traces.message_grade = Grade::bad;
    }
}

void TraceExport::start(const TracesState& traces) {
    const TraceScope& scope = traces.scope;
    const TraceStore& store = scope.shown();
    std::vector<TraceTopic> cycles;
    const std::size_t last = store.find(scope.end_ns() + 1);
    for (std::size_t i = store.find(scope.begin_ns()); i < last; ++i) cycles.push_back(store.at(i));
    std::vector<TraceChannel> channels;
    for (std::size_t i = 0; i < kTraceChannels; ++i)
        if (traces.channels.test(i)) channels.push_back(static_cast<TraceChannel>(i));
    const std::string path = new_output("traces", ".csv").string();
    thread_ = std::thread([this, path, cycles = std::move(cycles), channels = std::move(channels)] {
        // Low priority; ignored if not permitted.
        const sched_param none{};
        static_cast<void>(sched_setscheduler(0, SCHED_IDLE, &none));
        try {
            write_whole_file(path, trace_csv(cycles, channels));
            message_ = "wrote " + std::to_string(cycles.size()) + " cycles to " + path;
            grade_ = Grade::good;
        } catch (const std::exception& e) {
            message_ = e.what();
            grade_ = Grade::bad;
        }
        done_.store(true, std::memory_order_release);  // pairs with follow()
    });
}

}  // namespace tact
