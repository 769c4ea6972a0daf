// Refines one body beside the frame loop (ipc/scene/fit/refine.hpp).
//
// Thread   start(), poll() and cancel() on the frame thread; the work on one of its own, at low priority.
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
    std::string error;  // not empty: it failed
};

class RefineWorker {
public:
    // The content needs a map. It is prepared at the first start(), on the worker's thread.
    explicit RefineWorker(std::shared_ptr<const SceneContent> content) : content_(std::move(content)) {}
    ~RefineWorker() { cancel(); }  // and the future waits for the thread

    // Not while running(), and only for a structure of the content.
    void start(const FitBody& body);
    [[nodiscard]] bool running() const { return outcome_.valid(); }
    void cancel() { cancelled_ = true; }
    [[nodiscard]] std::optional<RefineOutcome> poll();  // once, when it is done

private:
    [[nodiscard]] RefineOutcome work(const FitBody& body);

    const std::shared_ptr<const SceneContent> content_;
    std::unique_ptr<DensityMap> map_;
    std::atomic<bool> cancelled_{false};
    std::future<RefineOutcome> outcome_;
};

}  // namespace tact
