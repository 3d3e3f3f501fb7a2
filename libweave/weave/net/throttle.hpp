#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>

namespace weave::net {

/// How fast one key may go on.
struct ThrottleRate {
    double burst = 10;              ///< so many at once, at least 1
    double per_second = 0.1;        ///< so many come back every second, above 0
    std::size_t most_keys = 10000;  ///< that memory is kept for
};

/// A token bucket per key, such as a login name or an address. Memory is bounded: when it is full, the keys
/// that have long been quiet are forgotten, and while none is, all keys not yet known share one bucket, so
/// that a flood of made-up keys neither frees a throttled one nor fills the memory. Safe to use from any
/// thread.
class Throttle {
  public:
    using Clock = std::chrono::steady_clock;

    explicit Throttle(const ThrottleRate& rate) : m_rate(rate) {}

    /// Takes a token of this key; false if it has none left.
    bool take(std::string_view key, Clock::time_point now = Clock::now());
    /// How long until the key has a token again, rounded up to whole seconds: for Retry-After.
    [[nodiscard]] std::chrono::seconds wait(std::string_view key, Clock::time_point now = Clock::now());
    /// Forgets what a key has used, after a login that succeeded.
    void forgive(std::string_view key);
    /// How many keys are remembered.
    [[nodiscard]] std::size_t keys() const;

  private:
    struct Bucket {
        std::string key;
        double tokens;
        Clock::time_point at;
    };
    using Buckets = std::list<Bucket>;

    [[nodiscard]] double tokens_at(const Bucket& bucket, Clock::time_point now) const;
    Bucket& bucket_of(std::string_view key, Clock::time_point now);
    void forget_quiet(Clock::time_point now);

    ThrottleRate m_rate;
    mutable std::mutex m_mutex;
    Buckets m_buckets;                                                 ///< the longest untouched first
    std::unordered_map<std::string_view, Buckets::iterator> m_places;  ///< keys point into m_buckets
    Bucket m_shared{{}, -1, {}};                                       ///< below 0: not used yet
};

}  // namespace weave::net
