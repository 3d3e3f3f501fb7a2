#include <weave/net/throttle.hpp>

#include <algorithm>
#include <cmath>

namespace weave::net {

double Throttle::tokens_at(const Bucket& bucket, Clock::time_point now) const {
    const double seconds = std::max(0.0, std::chrono::duration<double>(now - bucket.at).count());
    return std::min(m_rate.burst, bucket.tokens + seconds * m_rate.per_second);
}

/// Buckets that are full again mean nothing more. The longest untouched stand first, so it is enough to look
/// there.
void Throttle::forget_quiet(Clock::time_point now) {
    while (!m_buckets.empty() && tokens_at(m_buckets.front(), now) >= m_rate.burst) {
        m_places.erase(m_buckets.front().key);
        m_buckets.pop_front();
    }
}

Throttle::Bucket& Throttle::bucket_of(std::string_view key, Clock::time_point now) {
    Bucket* bucket = &m_shared;
    if (const auto known = m_places.find(key); known != m_places.end()) {
        m_buckets.splice(m_buckets.end(), m_buckets, known->second);
        bucket = &m_buckets.back();
    } else {
        forget_quiet(now);
        if (m_buckets.size() < m_rate.most_keys) {
            bucket = &m_buckets.emplace_back(Bucket{std::string(key), m_rate.burst, now});
            m_places.emplace(bucket->key, std::prev(m_buckets.end()));
        } else if (m_shared.tokens < 0) {
            m_shared.tokens = m_rate.burst;
        }
    }
    bucket->tokens = tokens_at(*bucket, now);
    bucket->at = std::max(bucket->at, now);
    return *bucket;
}

bool Throttle::take(std::string_view key, Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    Bucket& bucket = bucket_of(key, now);
    if (bucket.tokens < 1) return false;
    bucket.tokens -= 1;
    return true;
}

std::chrono::seconds Throttle::wait(std::string_view key, Clock::time_point now) {
    const std::lock_guard lock(m_mutex);
    const double missing = std::max(0.0, 1 - bucket_of(key, now).tokens);
    return std::chrono::seconds(static_cast<std::int64_t>(std::ceil(missing / m_rate.per_second)));
}

void Throttle::forgive(std::string_view key) {
    const std::lock_guard lock(m_mutex);
    const auto known = m_places.find(key);
    if (known == m_places.end()) return;
    const auto place = known->second;
    m_places.erase(known);
    m_buckets.erase(place);
}

std::size_t Throttle::keys() const {
    const std::lock_guard lock(m_mutex);
    return m_buckets.size();
}

}  // namespace weave::net
