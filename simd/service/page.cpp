#include <simd/service/page.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <simd/daemon/room.hpp>
#include <string>
#include <utility>
#include <vector>

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
th,td{text-align:right;vertical-align:bottom;padding:.4rem .6rem;border-top:1px solid var(--line)}td{white-space:nowrap}tr:first-child th{border-top:0}
th,td::before{font-weight:600;color:var(--soft)}th:nth-child(-n+2),td:nth-child(-n+2){text-align:left}
@media (max-width:60rem){body{padding:1.5rem 1rem}table,tbody{display:block}tr.heads{display:none}
tr{display:grid;grid-template-columns:repeat(auto-fit,minmax(15rem,1fr));column-gap:2rem;padding:.4rem .8rem}tr+tr+tr{border-top:1px solid var(--line)}
td,td:nth-child(-n+2){display:flex;justify-content:space-between;gap:1rem;text-align:right;padding:.1rem 0;border:0}td::before{content:attr(data-head)}}
</style></head><body>
)";

std::string number_text(double value, const char* form) {
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), form, value);
    return text.data();
}

/// A table with these heads. Each cell knows its own: on a narrow screen, where a row stands as a block, it is shown beside it.
class Table {
  public:
    explicit Table(std::vector<std::string> heads) : m_heads(std::move(heads)) {
        m_text = "<div class=\"wide\"><table><tr class=\"heads\">";
        for (const std::string& name : m_heads) m_text += "<th>" + name + "</th>";
        m_text += "</tr>\n";
    }
    void add_row(const std::vector<std::string>& cells) {
        m_text += "<tr>";
        for (std::size_t k = 0; k < cells.size(); ++k) m_text += "<td data-head=\"" + m_heads[k] + "\">" + cells[k] + "</td>";
        m_text += "</tr>\n";
    }
    [[nodiscard]] std::string text() const { return m_text + "</table></div>\n"; }

  private:
    std::vector<std::string> m_heads;
    std::string m_text;
};

std::string whole_text(const Json& number) {
    return std::to_string(number.get<std::uint64_t>());
}

std::string count_text(const Json& works) {
    return works.empty() ? "" : " (" + std::to_string(works.size()) + ")";
}

std::string residual_text(const Json& residual) {
    return residual.is_null() || residual.get<double>() <= 0 ? "–" : number_text(residual.get<double>(), "%.1e");
}

std::string sessions_table(const Json& sessions) {
    if (sessions.empty()) return "<p>No session is open.</p>\n";
    Table table({"Session", "State", "Steps", "Steps a second", "Residual", "Points", "Memory", "Computed", "Watched by"});
    for (const Json& session : busiest_first(sessions)) {
        table.add_row({whole_text(session.at("session")), phase_text(session), whole_text(session.at("step")), number_text(session.at("steps_per_second"), "%.0f"),
                       residual_text(session.at("residual")), whole_text(session.at("points")), memory_text(session.at("memory_bytes")),
                       time_text(session.at("computed_s")), whole_text(session.at("clients"))});
    }
    return table.text();
}

std::string jobs_table(const Json& jobs) {
    if (jobs.empty()) return "<p>No job waits or runs.</p>\n";
    Table table({"Job", "State", "Steps", "Steps a second", "Residual", "Points", "Memory", "Computed", "Still takes"});
    for (const Json& job : busiest_first(jobs)) {
        const Json& left = job.at("left_s");
        const bool has_begun = job.at("points") > 0;
        table.add_row({whole_text(job.at("job")), phase_text(job), whole_text(job.at("step")), has_begun ? number_text(job.at("steps_per_second"), "%.0f") : "–", residual_text(job.at("residual")),
                       has_begun ? whole_text(job.at("points")) : "–", has_begun ? memory_text(job.at("memory_bytes")) : "–",
                       has_begun ? time_text(job.at("computed_s")) : "–", left.is_null() ? "–" : "about " + time_text(left)});
    }
    return table.text();
}

}  // namespace

std::vector<Json> busiest_first(const Json& works) {
    const auto rank = [](const Json& work) {
        const std::string phase = work.at("phase");
        return phase == "running" ? 0 : phase == "waiting" ? 1 : phase == "paused" ? 2 : 3;
    };
    std::vector<Json> sorted(works.begin(), works.end());
    std::ranges::stable_sort(sorted, {}, rank);
    return sorted;
}

std::string phase_text(const Json& work) {
    std::string phase = work.at("phase");
    std::ranges::replace(phase, '_', ' ');
    return phase;
}

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
            whole_text(status.at("threads")) + " threads; " + whole_text(status.at("turns_waiting")) +
            " wait to compute; " + whole_text(status.at("clients")) + " connections</p>\n";
    page += "<h2>Memory</h2><div class=\"bar\"><i style=\"width:" + number_text(share, "%.1f") + "%\"></i></div><p>" + memory_text(promised) + " of " +
            memory_text(whole) + " promised</p>\n";
    page += "<h2>Sessions" + count_text(status.at("sessions")) + "</h2>\n" + sessions_table(status.at("sessions"));
    page += "<h2>Jobs" + count_text(status.at("jobs")) + "</h2>\n" + jobs_table(status.at("jobs"));
    return page + "</body></html>\n";
}

}  // namespace weave::simd
