// Refines one body in the background (ipc/scene/fit/refine.hpp).
//
// Thread   start(), poll() and cancel() on the frame thread; the work on its own thread, at low priority.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "gui/docking/fit_worker.hpp"
#include "ipc/scene/fit/refine.hpp"

namespace tact {

struct RefineOutcome {
    FitBody start;
    RefineResult result;
    std::string error;  // not empty: failed
};

class RefineWorker {
public:
    // The content needs a map, which the first start() prepares on the worker's thread.
    explicit RefineWorker(std::shared_ptr<const SceneContent> content) : content_(std::move(content)) {}
    ~RefineWorker() { cancel(); }  // the future's destructor then waits for the thread

    // Call only if not running(), and for a structure of the content.
    void start(const FitBody& body);
    [[nodiscard]] bool running() const { return outcome_.valid(); }
    void cancel() { cancelled_ = true; }
    [[nodiscard]] std::optional<RefineOutcome> poll();  // once, when done

private:
    [[nodiscard]] RefineOutcome work(const FitBody& body);

    const std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<DensityMap> map_;
    std::atomic<bool> cancelled_{false};
    std::future<RefineOutcome> outcome_;
};

}  // namespace tact
