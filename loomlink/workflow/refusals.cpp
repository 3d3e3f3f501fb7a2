#include <loomlink/workflow/refusals.hpp>

#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_place = 100, most_subject = 150, most_why = 1000, most_entries = 16;
constexpr std::int64_t largest_number = std::int64_t{1} << 53;  // JSON keeps whole numbers up to here

/// Members that say where an attempt was to reach. None of them is free text.
constexpr std::array<std::string_view, 20> places{
    "branch", "design", "design_sha256", "document_sha256", "end",  "expected",       "feeders", "file",
    "key",    "loom",   "looms",         "operators",       "pick", "profile_sha256", "release", "revision",
    "roles",  "rule",   "sha256",        "supersedes"};

std::string shortened(const std::string& text, std::size_t most) {
    const std::string line = on_one_line(text);
    if (line.size() <= most) return line;
    std::size_t end = 0;
    for (std::size_t next = 0; next <= most; next += utf8_length(std::string_view(line).substr(next)))
        end = next;
    return line.substr(0, end) + "…";
}

/// A value as a refusal tells it; nothing where it is more than a place.
Json told(const Json& value) {
    if (value.is_string()) return shortened(value.get_ref<const std::string&>(), most_place);
    if (!value.is_number_integer()) return {};
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t(largest_number)) return {};
    return value.get<std::int64_t>() >= -largest_number ? value : Json();
}

Json told_list(const Json& list) {
    Json some = Json::array();
    for (std::size_t k = 0; k < std::min(list.size(), most_entries); ++k)
        if (Json one = told(list[k]); !one.is_null()) some.push_back(std::move(one));
    return some;
}

}  // namespace

Deed refusal_record(const Deed& attempt, const Error& error) {
    // The place of a denial is a word for programs; that of other errors is where the trouble lies.
    const std::string why = error.code == ErrorCode::refused ? error.message : error.text();
    Deed record{"refused",
                shortened(attempt.subject, most_subject),
                shortened(why, most_why),
                {{"what", attempt.kind}}};
    for (const std::string_view place : places) {
        const auto given = attempt.data.find(place);
        if (given == attempt.data.end()) continue;
        Json value = given->is_array() ? told_list(*given) : told(*given);
        if (!value.is_null()) record.data[std::string(place)] = std::move(value);
    }
    return record;
}

std::optional<std::uint64_t> RefusalGauge::admit(const std::string& login, const Deed& record, bool always,
                                                 Instant now) {
    const std::string same =
        sha256_hex(canonical_json(Json::array({login, record.subject, record.reason, record.data})));
    const net::Throttle::Clock::time_point moment(now.time_since_epoch());
    const bool is_written = always || (m_recent.is_new(same, now) && m_rate.take(login, moment));
    const std::lock_guard lock(m_mutex);
    if (is_written) {
        const auto before = m_left_out.extract(login);
        return before ? before.mapped() : 0;
    }
    ++m_left_out[login];
    return {};
}

}  // namespace weave::loomlink
