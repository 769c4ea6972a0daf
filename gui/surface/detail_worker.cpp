#include "gui/surface/detail_worker.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <utility>

namespace tact {
namespace {

constexpr std::chrono::milliseconds kEach{25};  // between updates

}  // namespace

DetailWorker::DetailWorker(std::shared_ptr<const SceneContent> content)
    : content_(std::move(content)), thread_([this] { work(); }) {}

DetailWorker::~DetailWorker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void DetailWorker::request(const std::optional<DetailRequest>& request) {
    {
        const std::lock_guard lock(mutex_);
        if (request == request_) return;
        request_ = request;
        fresh_ = true;
    }
    changed_.notify_all();
}

std::optional<DetailMesh> DetailWorker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, std::nullopt);
}

std::string DetailWorker::error() {
    const std::lock_guard lock(mutex_);
    return error_;
}

void DetailWorker::work() {
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);  // this thread, on Linux
    try {
        std::unique_ptr<DetailCut> cut;
        std::unique_lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return stop_ || (fresh_ && request_); });
            if (stop_) return;
            const DetailRequest request = *request_;
            fresh_ = false;
            lock.unlock();
            if (!cut) cut = std::make_unique<DetailCut>(*content_);
            DetailMesh made = cut->step(request);
            lock.lock();
            fresh_ = fresh_ || !made.settled;  // continue refining
            news_ = std::move(made);
            changed_.wait_for(lock, kEach, [this] { return stop_; });
        }
    } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        error_ = e.what();
    }
}

}  // namespace tact
