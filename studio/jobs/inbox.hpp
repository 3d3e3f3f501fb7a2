#pragma once

#include <weave/wire/message.hpp>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <variant>

namespace weave::studio {

struct RunOrder {};
struct PauseOrder {};
struct StepOrder {
    std::uint64_t steps = 1;
};
/// What the window asks of a run, in its order.
using Order = std::variant<RunOrder, PauseOrder, StepOrder, wire::Parameters, wire::Pins, wire::Fields, Flip>;

/// How a computing thread is to end.
enum class Finish : std::uint8_t {
    no,
    report,  ///< with the yarns as they lie
    leave,   ///< at once: nobody looks any more
};

/// What the window has asked for, until the computing thread gets to it.
class Inbox {
  public:
    /// From the window's thread. Values that are asked for anew take the place of those that wait last: a
    /// slider that is dragged asks for its last place alone.
    void order(Order order);
    void finish(Finish finish);

    [[nodiscard]] Finish finish();
    [[nodiscard]] std::deque<Order> take();
    /// Until something was asked for since the last take(), or it is to finish; or for so long.
    void wait(std::optional<std::chrono::milliseconds> most = {});

  private:
    std::mutex m_mutex;
    std::condition_variable m_came;
    std::deque<Order> m_orders;
    Finish m_finish = Finish::no;
};

}  // namespace weave::studio
