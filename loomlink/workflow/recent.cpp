#include <loomlink/workflow/recent.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_keys = 10000;

}  // namespace

bool Recent::is_new(const std::string& key, Instant now) {
    const std::lock_guard lock(m_mutex);
    if (m_seen.size() >= most_keys)
        std::erase_if(m_seen, [&](const auto& entry) { return entry.second + m_again <= now; });
    if (m_seen.size() >= most_keys) m_seen.clear();  // rather one record too many than none
    const auto [place, is_first] = m_seen.try_emplace(key, now);
    if (!is_first && now < place->second + m_again) return false;
    place->second = now;
    return true;
}

void Recent::forget(const std::string& key) {
    const std::lock_guard lock(m_mutex);
    m_seen.erase(key);
}

}  // namespace weave::loomlink
