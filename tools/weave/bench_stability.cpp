// The catalogue of extremes as a benchmark.

#include "bench_stability.hpp"

namespace weave::program {

namespace {

constexpr const char* expectations[]{"rest", "told", "no rest", "refused"};

std::string case_row(const Json& one) {
    const std::string fault = one.at("fault");
    return "| " + one.at("name").get<std::string>() + " | " + one.at("about").get<std::string>() + " | " +
           one.at("expected").get<std::string>() + " | " + in_words("%.0f", one.at("points")) + " | " +
           in_words("%.0f", one.at("steps")) + " | " + in_words("%.2f", one.at("seconds")) + " | " +
           one.at("report").get<std::string>() + (fault.empty() ? "" : " **BAD: " + fault + "**") + " |\n";
}

}  // namespace

Json measure_extreme(const sim::Extreme& extreme, const BenchOptions& options) {
    const sim::ExtremeLimits limits{.most_seconds = options.seconds, .threads = options.threads};
    const sim::ExtremeEnd end = extreme.run(limits);
    std::string why;
    const bool good = sim::is_good(extreme, end, limits, why);
    return {{"name", extreme.name},
            {"about", extreme.about},
            {"expected", expectations[static_cast<std::size_t>(extreme.expected)]},
            {"good", good},
            {"fault", why},
            {"converged", end.converged},
            {"refused", end.refused},
            {"residual", end.residual},
            {"overlap", end.overlap},
            {"passed_through", end.passed_through},
            {"points", end.points},
            {"steps", end.iterations},
            {"seconds", end.seconds},
            {"report", end.report}};
}

std::string stability_table(const Json& cases, const Json& machine) {
    std::size_t bad = 0;
    for (const Json& one : cases) bad += one.at("good").get<bool>() ? 0 : 1;
    std::string text =
        "# The extremes\n\nWritten by `weave bench stability`. " + machine_line(machine) + ". " +
        std::to_string(cases.size()) + " cases, " + std::to_string(bad) +
        " bad.\n\n| Case | What it is | Must | Points | Steps | s | Ended |\n|---|---|---|---|---|---|---|\n";
    for (const Json& one : cases) text += case_row(one);
    return text;
}

}  // namespace weave::program
