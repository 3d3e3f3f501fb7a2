// gpu_bench [--json FILE] [--on cores] [CASE...]: measures a device, tells its figures, and writes them to FILE too. Ends with 77 where
// there is no device that can be used. With `--on cores` the device's solver runs on the processor, in the cases that only relax.

#include "cases.hpp"
#include "on_cores.hpp"

#include <weave/sim/device/devices.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace {

using weave::gpu_bench::Figure;
using weave::gpu_bench::Figures;
using Json = nlohmann::ordered_json;

/// A case asks for a device, or only for who relaxes.
struct Case {
    std::string name;
    Figures (*of_device)() = nullptr;
    Figures (*of_relaxer)(weave::sim::DeviceRelaxer&) = nullptr;
};
const std::vector<Case> cases{
    {"copy", weave::gpu_bench::measure_copy},
    {"launches", weave::gpu_bench::measure_launches},
    {"barriers", weave::gpu_bench::measure_barriers},
    {"contact", weave::gpu_bench::measure_contact},
    {"table1", nullptr, weave::gpu_bench::measure_table1},
    {"batch", nullptr, weave::gpu_bench::measure_batch},
    {"live", nullptr, weave::gpu_bench::measure_live},
    {"large", nullptr, weave::gpu_bench::measure_large},
};

struct Wish {
    std::vector<std::string> cases;
    std::string file;
    bool on_cores = false;
};

/// Nothing where the words are not understood; what is wrong has been told.
std::optional<Wish> understood(const std::vector<std::string>& words) {
    Wish wish;
    for (std::size_t k = 0; k < words.size(); ++k) {
        const bool has_next = k + 1 < words.size();
        if (words[k] == "--json" && has_next) {
            wish.file = words[++k];
        } else if (words[k] == "--on" && has_next && words[k + 1] == "cores") {
            wish.on_cores = true;
            ++k;
        } else if (words[k] == "--on" || words[k] == "--json") {
            std::fprintf(stderr, "gpu_bench: %s needs %s after it\n", words[k].c_str(), words[k] == "--on" ? "'cores'" : "a file");
            return {};
        } else if (std::ranges::any_of(cases, [&](const Case& known) { return known.name == words[k]; })) {
            wish.cases.push_back(words[k]);
        } else {
            std::fprintf(stderr, "gpu_bench: no case is called %s\nusage: gpu_bench [--json FILE] [--on cores] [", words[k].c_str());
            for (const Case& known : cases) std::fprintf(stderr, "%s%s", known.name.c_str(), &known == &cases.back() ? "]...\n" : "|");
            return {};
        }
    }
    for (const std::string& name : wish.cases) {
        const Case& asked = *std::ranges::find(cases, name, &Case::name);
        if (!wish.on_cores || asked.of_relaxer) continue;
        std::fprintf(stderr, "gpu_bench: %s measures a device, not the cores\n", name.c_str());
        return {};
    }
    return wish;
}

/// What is measured so far, for whoever wants it in a file; false where that cannot be written.
bool write(const Json& report, const std::string& file) {
    return file.empty() || std::ofstream(file) << report.dump(1) << '\n';
}

/// Measures a case; what goes wrong stays with it.
Json measure(const Case& one, weave::sim::DeviceRelaxer& relaxer, bool& failed) {
    Json measured{{"case", one.name}, {"figures", Json::array()}};
    try {
        for (const Figure& figure : one.of_device ? one.of_device() : one.of_relaxer(relaxer))
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
    std::fflush(stdout);
    if (measured.contains("error")) std::printf("%s FAILED: %s\n", name.c_str(), text(measured, "error").c_str());
}

}  // namespace

int main(int count, char** words) {
    const std::optional<Wish> wish = understood({words + 1, words + count});
    if (!wish) return 2;
    Json report{{"device", "the processor's cores"}, {"cases", Json::array()}};
    std::unique_ptr<weave::sim::DeviceRelaxer> relaxer;
    if (wish->on_cores) {
        relaxer = weave::gpu_bench::relaxer_on_cores();
    } else {
        const weave::sim::Devices found = weave::sim::devices();
        if (!found.why_none.empty()) {
            std::fprintf(stderr, "gpu_bench: skipped: %s\n", found.why_none.c_str());
            return 77;
        }
        const auto usable = std::ranges::find_if(found.all, [](const weave::sim::Device& device) { return device.trouble.empty(); });
        report["device"] = usable->name;
        report["driver"] = weave::sim::cuda_version_words(found.driver);
        report["runtime"] = weave::sim::cuda_version_words(found.runtime);
        try {
            relaxer = weave::sim::DeviceRelaxer::on(*usable);
        } catch (const weave::sim::DeviceError& error) {
            std::fprintf(stderr, "gpu_bench: %s\n", error.what());
            return 1;
        }
    }
    bool failed = false;
    for (const Case& one : cases) {
        const bool is_asked = wish->cases.empty() ? !(wish->on_cores && one.of_device) : std::ranges::find(wish->cases, one.name) != wish->cases.end();
        if (!is_asked) continue;
        report["cases"].push_back(measure(one, *relaxer, failed));
        print(report["cases"].back());
        if (!write(report, wish->file)) { // after each: who is stopped has told what was measured by then
            std::fprintf(stderr, "gpu_bench: %s cannot be written\n", wish->file.c_str());
            return 5;
        }
    }
    return failed ? 1 : 0;
}
