#pragma once

#include <weave/core/result.hpp>
#include <weave/net/throttle.hpp>

#include <cstdint>
#include <loomlink/workflow/deed.hpp>
#include <loomlink/workflow/recent.hpp>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace weave::loomlink {

/// What the log says of an attempt that was refused: `what` was attempted, why not, and the places that it
/// named (revision, loom, release, file and their like), each on one line and cut. Texts that people typed,
/// documents and statements are left out, and whatever member is not known here.
Deed refusal_record(const Deed& attempt, const Error& error);

/// Which refused attempts of people who are signed in get a record of their own. The same attempt that is
/// refused for the same reason gets one in a while; beyond that each person has so many at a time, so that
/// nobody fills the log. Safe to use from any thread.
class RefusalGauge {
  public:
    RefusalGauge(std::chrono::minutes again, const net::ThrottleRate& rate)
        : m_recent(again), m_rate(rate) {}

    /// How many attempts of this person since the last record were left without one, where `record` is to be
    /// written; nothing where it is not. `always`: however often it came (it is held back elsewhere).
    std::optional<std::uint64_t> admit(const std::string& login, const Deed& record, bool always,
                                       Instant now);

  private:
    Recent m_recent;
    net::Throttle m_rate;
    std::mutex m_mutex;
    std::map<std::string, std::uint64_t> m_left_out;
};

}  // namespace weave::loomlink
