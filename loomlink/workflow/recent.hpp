#pragma once

#include <weave/keys/utc.hpp>

#include <chrono>
#include <map>
#include <mutex>
#include <string>

namespace weave::loomlink {

/// What came up within the last while, so that the same thing is not written down over and over. Keeps 10,000
/// keys at most, and forgets all of them rather than tell nothing of a new one. Safe to use from any thread.
class Recent {
  public:
    explicit Recent(std::chrono::minutes again) : m_again(again) {}

    /// Whether this did not come up within the while before `now`; from now on it did.
    bool is_new(const std::string& key, Instant now);
    void forget(const std::string& key);

  private:
    std::chrono::minutes m_again;
    std::mutex m_mutex;
    std::map<std::string, Instant> m_seen;
};

}  // namespace weave::loomlink
