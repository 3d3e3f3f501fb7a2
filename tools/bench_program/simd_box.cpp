#include "simd_box.hpp"

#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/plan.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace weave::bench {

namespace {

std::size_t points_of(const Design& design) {
    sim::SimulationRequest request;
    request.reduce = false;
    std::size_t points = 0;
    for (const sim::SimYarn& yarn : must(sim::make_plan(design, *evaluate(design)->block, request), "the cloth cannot be planned").scene.yarns)
        points += yarn.control.size();
    return points;
}

Design tiled(std::uint32_t across, std::uint32_t along) {
    Design design = find_sample("angle-interlock-b")->make();
    design.blocks["cloth"] = std::make_shared<const Node>(Node{TileOperation{design.root, across, along, 1}, {}});
    design.root = "cloth";
    return design;
}

}  // namespace

void must(const Status& status, const char* what) {
    if (!status) throw std::runtime_error(std::string(what) + ": " + status.error().text());
}

SimdBox::SimdBox(std::size_t threads, std::size_t people) {
    const Json config{{"port", 0},     {"plain", true},           {"threads", threads},
                      {"sessions", 200}, {"sessions_per_person", 200}};
    std::ofstream(m_folder.path() / "config.json") << config.dump();
    for (std::size_t k = 0; k < people; ++k) {
        const Json told = answer_of_program("simd", {"token", "add", (m_folder.path() / "box").string(), "person-" + std::to_string(k), "--json"},
                                            m_folder.path() / "told.txt");
        m_tokens.push_back(told.at("token"));
    }
    start();
}

void SimdBox::start() {
    m_program.emplace("simd", std::vector<std::string>{"serve", (m_folder.path() / "box").string(), "--config", (m_folder.path() / "config.json").string(), "--json"},
                      m_folder.path() / "told.txt");
}

void SimdBox::kill() {
    m_program->end(SIGKILL);
}

wire::ServerPlace SimdBox::place() const {
    wire::ServerPlace place = must(wire::place_of("unix:" + (m_folder.path() / "box" / "simd.sock").string()), "the socket");
    place.options.answer_time = std::chrono::minutes(2);  // a busy machine is measured, not given up
    return place;
}

wire::ServerPlace SimdBox::place_of_person(std::size_t person) const {
    wire::ServerPlace place = must(wire::place_of(m_program->introduction().at("url").get<std::string>()), "the address");
    must(wire::use_token(place, m_tokens.at(person)), "the token");
    place.options.answer_time = std::chrono::minutes(2);
    return place;
}

Json SimdBox::status() const {
    return must(parse_json(must(wire::download(place(), "/api/v1/status", std::uint64_t{1} << 24), "the status")), "the status");
}

Json SimdBox::session(std::uint64_t number) const {
    const Json told = status();
    for (const Json& one : told.at("sessions")) {
        if (one.at("session") == number) return one;
    }
    throw std::runtime_error("there is no session " + std::to_string(number));
}

std::optional<pid_t> SimdBox::worker(std::uint64_t number) const {
    const Json told = session(number);
    return told.contains("worker") ? std::optional(told.at("worker").get<pid_t>()) : std::nullopt;
}

std::optional<double> SimdBox::checkpoint_age_s(std::uint64_t session) const {
    std::error_code missing;
    const auto written = std::filesystem::last_write_time(m_folder.path() / "box" / "sessions" / std::to_string(session) / "checkpoint", missing);
    if (missing) return {};
    return std::chrono::duration<double>(std::filesystem::file_time_type::clock::now() - written).count();
}

double SimdBox::cpu_s() const {
    constexpr int fields_before_user_time = 11;  // behind the program's name, which ends with the last ')'
    std::ifstream file("/proc/" + std::to_string(m_program->process()) + "/stat");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string skipped;
    for (int k = 0; k < fields_before_user_time; ++k) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

TiledCloth tiled_cloth(std::size_t points) {
    const auto cells = static_cast<double>(points) / static_cast<double>(points_of(tiled(1, 1)));
    const auto across = static_cast<std::uint32_t>(std::max(1.0, std::floor(std::sqrt(cells))));
    const auto along = static_cast<std::uint32_t>(std::max(1.0, std::round(cells / across)));
    const Design design = tiled(across, along);
    return {write_document(design), points_of(design)};
}

wire::Simulation restless() {
    wire::Simulation simulation;
    simulation.plan.fidelity = sim::Fidelity::standard;
    simulation.plan.reduce = false;
    simulation.residual = 1e-15;
    return simulation;
}

wire::Parameters parameters_of_turn(std::size_t turn) {
    constexpr double less = 1.01, more = 1.04;
    wire::Parameters parameters;
    parameters.warp.strain = turn % 2 == 0 ? more : less;
    parameters.weft.radius_scale = turn % 4 < 2 ? more : less;
    return parameters;
}

Json circumstances() {
    std::string processor;
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; processor.empty() && std::getline(file, line);) {
        if (line.starts_with("model name")) processor = line.substr(line.find(':') + 2);
    }
    double load[1]{};
    static_cast<void>(::getloadavg(load, 1));
    const std::time_t now = std::time(nullptr);
    char at[32];
    std::strftime(at, sizeof at, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return {{"processor", processor}, {"cores", std::thread::hardware_concurrency()}, {"at", at}, {"load", load[0]}};
}

std::string told_circumstances(const Json& before, const Json& after) {
    char loads[80];
    std::snprintf(loads, sizeof loads, "load %.1f before, %.1f at the end", before.at("load").get<double>(), after.at("load").get<double>());
    return std::to_string(before.at("cores").get<int>()) + " cores, " + before.at("processor").get<std::string>() + "; " + before.at("at").get<std::string>() + "; " + loads;
}

}  // namespace weave::bench
