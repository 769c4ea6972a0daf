// Mailbox between the servo thread and the housekeeping thread, inside tact-rt. Neither ever waits.
//
// To the servo      orders (validated commands), the report of the visual process, a new force model, the stop signal
// To housekeeping   the old force model, a request to build another, a snapshot at a fault, the end of the run
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

// The state of the loop at the first fault.
struct FaultSnapshot {
    std::uint64_t cycle;
    std::int64_t taken_at_ns;
    std::int64_t lateness_ns;
    std::int64_t sample_age_ns;
    double measured;
    double pos_world_m[3];
    double velocity_world_m_s[3];
    double wanted_n[3];  // by the model
    double applied_before_n[3];
    std::uint64_t reason;  // RunReason
};

// One model on its way in, one on its way out.
class ModelHandover {
public:
    ModelHandover() = default;
    ModelHandover(const ModelHandover&) = delete;
    ModelHandover& operator=(const ModelHandover&) = delete;
    ~ModelHandover() {
        collect();
        const std::unique_ptr<ForceModel> never_taken(incoming_.exchange(nullptr));
    }

    // Housekeeping. False: the one before has not been taken yet; the model stays with the caller.
    bool offer(std::unique_ptr<ForceModel>& model) {
        ForceModel* expected = nullptr;
        // Release: the servo sees a whole model; pairs with take().
        if (!incoming_.compare_exchange_strong(expected, model.get(), std::memory_order_release))
            return false;
        static_cast<void>(model.release());
        return true;
    }
    // Housekeeping. The model that the servo no longer uses, to be destroyed off its thread.
    std::unique_ptr<ForceModel> collect() {
        return std::unique_ptr<ForceModel>(outgoing_.exchange(nullptr, std::memory_order_acquire));
    }
    // Servo. Null where nothing came, or where the old one still waits to be collected.
    ForceModel* take() noexcept TACT_RT {
        if (incoming_.load(std::memory_order_relaxed) == nullptr) return nullptr;
        if (outgoing_.load(std::memory_order_relaxed) != nullptr) return nullptr;
        return incoming_.exchange(nullptr, std::memory_order_acquire);
    }
    // Servo. Only after take() gave one; pairs with collect().
    void give_back(ForceModel* old) noexcept TACT_RT { outgoing_.store(old, std::memory_order_release); }

private:
    std::atomic<ForceModel*> incoming_{nullptr};
    std::atomic<ForceModel*> outgoing_{nullptr};
};

// One request at a time for a model that is built aside. The model itself comes back through ModelHandover.
// While one is under way nothing else is offered there, so the model that it is built like stays in use.
class BuildRequest {
public:
    // Servo. False: the one before is not settled.
    bool ask(const ForceModel& like, const ModelBodies& bodies) noexcept TACT_RT {
        if (state_.load(std::memory_order_relaxed) != State::none) return false;
        like_ = &like;
        bodies_ = bodies;
        state_.store(State::asked, std::memory_order_release);  // pairs with take()
        return true;
    }
    // Servo. Nothing could be built.
    [[nodiscard]] bool refused() const noexcept TACT_RT {
        return state_.load(std::memory_order_acquire) == State::refused;
    }
    // Servo: the model was taken, or the refusal seen.
    void settle() noexcept TACT_RT { state_.store(State::none, std::memory_order_relaxed); }

    // Housekeeping. True once for each request; like() and bodies() are its own until it answers.
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
    std::atomic<int> stop_signal{0};  // signal number, or -1: the run's time is over
    std::atomic<bool> ended{false};
    ServoPulse pulse;
};

}  // namespace tact
