// Keeps a DetailCut beside the frame loop.
//
// Thread   request() and take() on the frame thread, which never waits; the work on one of its own, at low priority,
//          that sleeps while nothing is requested for. The destructor waits for the step under way.
// Fails by error(): the forest cannot be used; nothing comes then.
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

    // The newest counts; none: rest.
    void request(const std::optional<DetailRequest>& request);
    // What has come since the last call.
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
