#include <array>
#include <cmath>
#include <cstdio>
#include <simd/daemon/room.hpp>
#include <simd/service/page.hpp>

namespace weave::simd {

namespace {

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="refresh" content="2"><title>simd</title>
<style>
:root{color-scheme:light dark;--ink:#1d2430;--soft:#5c6675;--line:#d8dde5;--ground:#f6f7f9;--card:#fff;--busy:#2c6e49}
@media (prefers-color-scheme:dark){:root{--ink:#e8ebf0;--soft:#9aa4b3;--line:#333b47;--ground:#14181e;--card:#1c222a;--busy:#7fc8a0}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--ground);margin:0 auto;max-width:62rem;padding:1.5rem}
h1{font-size:1.4rem;margin:0}h2{font-size:1.05rem;margin:1.8rem 0 .5rem}p{margin:.3rem 0;color:var(--soft)}
.bar{height:.7rem;background:var(--line);border-radius:.35rem;overflow:hidden}.bar i{display:block;height:100%;background:var(--busy)}
div.wide{overflow-x:auto;background:var(--card);border:1px solid var(--line);border-radius:.5rem}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:right;padding:.4rem .8rem;border-top:1px solid var(--line);white-space:nowrap}tr:first-child th{border-top:0}
th{font-weight:600;color:var(--soft)}th:nth-child(-n+2),td:nth-child(-n+2){text-align:left}
</style></head><body>
)";

std::string number_text(double value, const char* form) {
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), form, value);
    return text.data();
}

std::string cell(const std::string& text) {
    return "<td>" + text + "</td>";
}

std::string residual_text(const Json& residual) {
    return residual.is_null() || residual.get<double>() <= 0 ? "–" : number_text(residual.get<double>(), "%.1e");
}

std::string sessions_table(const Json& sessions) {
    if (sessions.empty()) return "<p>No session is open.</p>\n";
    std::string table = "<div class=\"wide\"><table><tr><th>Session</th><th>State</th><th>Steps</th><th>Steps a second</th><th>Residual</th>"
                        "<th>Points</th><th>Memory</th><th>Computed</th><th>Watched by</th></tr>\n";
    for (const Json& session : sessions) {
        table += "<tr>" + cell(std::to_string(session.at("session").get<std::uint64_t>())) + cell(session.at("phase")) +
                 cell(std::to_string(session.at("step").get<std::uint64_t>())) + cell(number_text(session.at("steps_per_second"), "%.0f")) +
                 cell(residual_text(session.at("residual"))) + cell(std::to_string(session.at("points").get<std::uint64_t>())) +
                 cell(memory_text(session.at("memory_bytes"))) + cell(time_text(session.at("computed_s"))) +
                 cell(std::to_string(session.at("clients").get<std::uint64_t>())) + "</tr>\n";
    }
    return table + "</table></div>\n";
}

std::string jobs_table(const Json& jobs) {
    if (jobs.empty()) return "<p>No job waits or runs.</p>\n";
    std::string table = "<div class=\"wide\"><table><tr><th>Job</th><th>State</th><th>Steps</th><th>Residual</th><th>Points</th><th>Memory</th>"
                        "<th>Computed</th><th>Still takes</th></tr>\n";
    for (const Json& job : jobs) {
        const Json& left = job.at("left_s");
        const bool has_begun = job.at("points") > 0;
        table += "<tr>" + cell(std::to_string(job.at("job").get<std::uint64_t>())) + cell(job.at("phase")) +
                 cell(std::to_string(job.at("step").get<std::uint64_t>())) + cell(residual_text(job.at("residual"))) +
                 cell(has_begun ? std::to_string(job.at("points").get<std::uint64_t>()) : "–") + cell(has_begun ? memory_text(job.at("memory_bytes")) : "–") +
                 cell(has_begun ? time_text(job.at("computed_s")) : "–") + cell(left.is_null() ? "–" : "about " + time_text(left)) + "</tr>\n";
    }
    return table + "</table></div>\n";
}

}  // namespace

std::string time_text(double seconds) {
    if (seconds < 10) return number_text(seconds, "%.1f s");
    const auto whole = static_cast<long long>(std::llround(seconds));
    std::array<char, 48> text{};
    if (whole < 60) std::snprintf(text.data(), text.size(), "%lld s", whole);
    else if (whole < 3600) std::snprintf(text.data(), text.size(), "%lld min %02lld s", whole / 60, whole % 60);
    else std::snprintf(text.data(), text.size(), "%lld h %02lld min", whole / 3600, whole % 3600 / 60);
    return text.data();
}

std::string status_page(const Json& status, const std::string& version) {
    const Json& memory = status.at("memory");
    const auto whole = memory.at("bytes").get<std::uint64_t>(), promised = memory.at("promised_bytes").get<std::uint64_t>();
    const double share = whole == 0 ? 0 : 100 * static_cast<double>(promised) / static_cast<double>(whole);
    std::string page = head;
    page += "<h1>simd " + version + "</h1><p>has served for " + time_text(status.at("up_s")) + " with " +
            std::to_string(status.at("threads").get<std::uint64_t>()) + " threads; " + std::to_string(status.at("turns_waiting").get<std::uint64_t>()) +
            " wait to compute; " + std::to_string(status.at("clients").get<std::uint64_t>()) + " connections</p>\n";
    page += "<h2>Memory</h2><div class=\"bar\"><i style=\"width:" + number_text(share, "%.1f") + "%\"></i></div><p>" + memory_text(promised) + " of " +
            memory_text(whole) + " promised</p>\n";
    page += "<h2>Sessions</h2>\n" + sessions_table(status.at("sessions"));
    page += "<h2>Jobs</h2>\n" + jobs_table(status.at("jobs"));
    return page + "</body></html>\n";
}

}  // namespace weave::simd
