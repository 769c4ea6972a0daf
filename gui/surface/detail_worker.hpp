// Updates a DetailCut in the background.
//
// Thread   request() and take() on the frame thread, which never waits; the work on its own thread, at low priority,
//          which sleeps while nothing is requested. The destructor waits for the current step.
// Fails by error(): the forest cannot be used; no mesh follows.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "gui/surface/detail_mesh.hpp"

namespace tact {

class DetailWorker {
public:
    explicit DetailWorker(std::shared_ptr<const SceneContent> content);
    ~DetailWorker();
    DetailWorker(const DetailWorker&) = delete;
    DetailWorker& operator=(const DetailWorker&) = delete;

    // The newest request counts; none: pause.
    void request(const std::optional<DetailRequest>& request);
    // Returns a mesh made since the last call, if any.
    [[nodiscard]] std::optional<DetailMesh> take();
    [[nodiscard]] std::string error();

private:
    void work();

    const std::shared_ptr<const SceneContent> content_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<DetailRequest> request_;
    std::optional<DetailMesh> news_;
    std::string error_;
    bool fresh_ = false, stop_ = false;
    std::thread thread_;
};

}  // namespace tact
