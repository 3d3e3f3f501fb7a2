// gpu_bench [--json FILE] [CASE...]: measures a device, tells its figures, and writes them to FILE too. Ends with 77 where there is no
// device that can be used.

#include "cases.hpp"

#include <weave/sim/device/devices.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using weave::gpu_bench::Figure;
using Json = nlohmann::ordered_json;

const std::vector<std::pair<std::string, std::vector<Figure> (*)()>> cases{
    {"copy", weave::gpu_bench::measure_copy},
    {"launches", weave::gpu_bench::measure_launches},
    {"barriers", weave::gpu_bench::measure_barriers},
};

/// Measures a case; what goes wrong stays with it.
Json measure(const std::string& name, std::vector<Figure> (*run)(), bool& failed) {
    Json measured{{"case", name}, {"figures", Json::array()}};
    try {
        for (const Figure& figure : run())
            measured["figures"].push_back({{"name", figure.name}, {"value", figure.value}, {"unit", figure.unit}, {"how", figure.how}});
    } catch (const std::exception& error) {
        measured["error"] = error.what();
        failed = true;
    }
    return measured;
}

std::string text(const Json& of, const char* key) {
    return of.at(key).get<std::string>();
}

void print(const Json& measured) {
    const std::string name = text(measured, "case");
    for (const Json& figure : measured.at("figures")) {
        std::printf("%-10s %-48s %12.3f %-5s %s\n", name.c_str(), text(figure, "name").c_str(), figure.at("value").get<double>(),
                    text(figure, "unit").c_str(), text(figure, "how").c_str());
    }
    if (measured.contains("error")) std::printf("%s FAILED: %s\n", name.c_str(), text(measured, "error").c_str());
}

}  // namespace

int main(int count, char** words) {
    std::vector<std::string> asked(words + 1, words + count);
    std::string file;
    if (asked.size() >= 2 && asked[0] == "--json") {
        file = asked[1];
        asked.erase(asked.begin(), asked.begin() + 2);
    }
    for (const std::string& name : asked) {
        if (std::ranges::none_of(cases, [&](const auto& known) { return known.first == name; })) {
            std::fprintf(stderr, "gpu_bench: no case is called %s\n", name.c_str());
            return 2;
        }
    }
    const weave::sim::Devices found = weave::sim::devices();
    if (!found.why_none.empty()) {
        std::fprintf(stderr, "gpu_bench: skipped: %s\n", found.why_none.c_str());
        return 77;
    }
    Json report{{"device", found.all.front().name},
                {"driver", weave::sim::cuda_version_words(found.driver)},
                {"runtime", weave::sim::cuda_version_words(found.runtime)},
                {"cases", Json::array()}};
    bool failed = false;
    for (const auto& [name, run] : cases) {
        if (!asked.empty() && std::ranges::find(asked, name) == asked.end()) continue;
        report["cases"].push_back(measure(name, run, failed));
        print(report["cases"].back());
    }
    if (!file.empty() && !(std::ofstream(file) << report.dump(1) << '\n')) {
        std::fprintf(stderr, "gpu_bench: %s cannot be written\n", file.c_str());
        return 5;
    }
    return failed ? 1 : 0;
}
