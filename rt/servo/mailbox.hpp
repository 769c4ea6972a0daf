// Mailbox between the servo thread and the housekeeping thread, inside tact-rt. Neither thread ever waits.
//
// To the servo      validated commands (orders), reports of the visual process, a new force model, the stop signal
// To housekeeping   the old force model, a request to build a model, the snapshot of a fault, the end of the run
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "ipc/shm/latest.hpp"
#include "ipc/topics/record.hpp"
#include "rt/force/force_model.hpp"
#include "rt/servo/servo_orders.hpp"
#include "rt/servo/servo_pulse.hpp"

namespace tact {

// State of the loop at the first fault.
struct FaultSnapshot {
    std::uint64_t cycle;
    std::int64_t taken_at_ns;
    std::int64_t lateness_ns;
    std::int64_t sample_age_ns;
    double measured;
    double pos_world_m[3];
    double velocity_world_m_s[3];
    double wanted_n[3];  // force requested by the model
    double applied_before_n[3];
    std::uint64_t reason;  // RunReason
};

// Exchanges force models: one slot for the new model, one for the old.
class ModelHandover {
public:
    ModelHandover() = default;
    ModelHandover(const ModelHandover&) = delete;
    ModelHandover& operator=(const ModelHandover&) = delete;
    ~ModelHandover() {
        collect();
        const std::unique_ptr<ForceModel> never_taken(incoming_.exchange(nullptr));
    }

    // Housekeeping. False: the servo has not taken the previous model yet; the caller keeps this one.
    bool offer(std::unique_ptr<ForceModel>& model) {
        ForceModel* expected = nullptr;
        // Release: publishes the complete model; pairs with take().
        if (!incoming_.compare_exchange_strong(expected, model.get(), std::memory_order_release))
            return false;
        static_cast<void>(model.release());
        return true;
    }
    // Housekeeping. Returns the model that the servo no longer uses, to destroy it off the servo thread.
    std::unique_ptr<ForceModel> collect() {
        return std::unique_ptr<ForceModel>(outgoing_.exchange(nullptr, std::memory_order_acquire));
    }
    // Servo. Null: no new model, or the old one has not been collected yet.
    ForceModel* take() noexcept TACT_RT {
        if (incoming_.load(std::memory_order_relaxed) == nullptr) return nullptr;
        if (outgoing_.load(std::memory_order_relaxed) != nullptr) return nullptr;
        return incoming_.exchange(nullptr, std::memory_order_acquire);
    }
    // Servo. Call only after take() returned a model; pairs with collect().
    void give_back(ForceModel* old) noexcept TACT_RT { outgoing_.store(old, std::memory_order_release); }

private:
    std::atomic<ForceModel*> incoming_{nullptr};
    std::atomic<ForceModel*> outgoing_{nullptr};
};

// Requests a model that another thread builds, one at a time. The model returns through ModelHandover. No other model
// is offered there meanwhile, so the model that serves as its pattern stays in use.
class BuildRequest {
public:
    // Servo. False: the previous request is not settled.
    bool ask(const ForceModel& like, const ModelBodies& bodies) noexcept TACT_RT {
        if (state_.load(std::memory_order_relaxed) != State::none) return false;
        like_ = &like;
        bodies_ = bodies;
        state_.store(State::asked, std::memory_order_release);  // pairs with take()
        return true;
    }
    // Servo. True: the model could not be built.
    [[nodiscard]] bool refused() const noexcept TACT_RT {
        return state_.load(std::memory_order_acquire) == State::refused;
    }
    // Servo. Call when the model was taken or the refusal handled.
    void settle() noexcept TACT_RT { state_.store(State::none, std::memory_order_relaxed); }

    // Housekeeping. True once per request; like() and bodies() stay valid until it answers.
    bool take() {
        State expected = State::asked;
        return state_.compare_exchange_strong(expected, State::taken, std::memory_order_acquire);
    }
    [[nodiscard]] const ForceModel& like() const { return *like_; }
    [[nodiscard]] const ModelBodies& bodies() const { return bodies_; }
    void refuse() { state_.store(State::refused, std::memory_order_release); }  // pairs with refused()

private:
    enum class State : std::uint32_t { none, asked, taken, refused };
    std::atomic<State> state_{State::none};
    const ForceModel* like_ = nullptr;
    ModelBodies bodies_;
};

struct ServoMailbox {
    ServoOrders orders;
    Latest<HousekeepingReport> housekeeping{};
    Latest<FaultSnapshot> fault{};
    ModelHandover model;
    BuildRequest build;
    std::atomic<int> stop_signal{0};  // signal number; -1: the run's time limit
    std::atomic<bool> ended{false};
    ServoPulse pulse;
};

}  // namespace tact
