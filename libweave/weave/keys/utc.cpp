#include <weave/keys/utc.hpp>

#include <weave/core/text.hpp>

#include <cstdio>

namespace weave {

namespace {

namespace chrono = std::chrono;

constexpr std::string_view shape = "0000-00-00T00:00:00.000Z";

Error no_moment(std::string_view text) {
    return bad_input("'" + on_one_line(text.substr(0, 40)) +
                     "' is not a moment in UTC as 2026-11-26T09:30:00.000Z");
}

bool has_shape(std::string_view text) {
    if (text.size() != shape.size()) return false;
    for (std::size_t k = 0; k < shape.size(); ++k) {
        const bool digit = text[k] >= '0' && text[k] <= '9';
        if (shape[k] == '0' ? !digit : text[k] != shape[k]) return false;
    }
    return true;
}

int part(std::string_view text, std::size_t from, std::size_t length) {
    return static_cast<int>(parse_whole(text.substr(from, length)).value_or(0));
}

}  // namespace

std::string utc_text(Instant instant) {
    const auto day = chrono::floor<chrono::days>(instant);
    const chrono::year_month_day date(day);
    const chrono::hh_mm_ss clock(instant - day);
    char text[64];
    const int length = std::snprintf(
        text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d.%03dZ", static_cast<int>(date.year()),
        static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
        static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
        static_cast<int>(clock.seconds().count()), static_cast<int>(clock.subseconds().count()));
    return {text, static_cast<std::size_t>(length)};
}

Result<Instant> parse_utc(std::string_view text) {
    if (!has_shape(text) || part(text, 0, 4) < 1970) return no_moment(text);
    const chrono::year_month_day date(chrono::year(part(text, 0, 4)),
                                      chrono::month(static_cast<unsigned>(part(text, 5, 2))),
                                      chrono::day(static_cast<unsigned>(part(text, 8, 2))));
    if (!date.ok()) return no_moment(text);
    const Instant instant = chrono::sys_days(date) + chrono::hours(part(text, 11, 2)) +
                            chrono::minutes(part(text, 14, 2)) + chrono::seconds(part(text, 17, 2)) +
                            chrono::milliseconds(part(text, 20, 3));
    if (utc_text(instant) != text) return no_moment(text);  // 25 o'clock would be one of the next day
    return instant;
}

}  // namespace weave
