#include "simulate_words.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace weave::program {

namespace {

Error usage_error(std::string message, std::string where) {
    return {ErrorCode::usage, std::move(message), std::move(where)};
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
    Number value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

/// What stands before and behind a sign; the second is empty where there is none.
std::pair<std::string, std::string> split(const std::string& text, char sign) {
    const std::size_t at = text.find(sign);
    return {text.substr(0, at), at == std::string::npos ? std::string() : text.substr(at + 1)};
}

/// `4,7`, a pick and an end from 1, as numbers from 0 within the block.
std::optional<std::array<std::size_t, 2>> crossing_of(const std::string& text, const Block& block) {
    const auto [pick, end] = split(text, ',');
    const std::optional<std::size_t> p = number_of<std::size_t>(pick), e = number_of<std::size_t>(end);
    if (!p || !e || *p < 1 || *e < 1 || *p > block.picks() || *e > block.ends()) return {};
    return std::array{*p - 1, *e - 1};
}

std::string size_of(const Block& block) {
    return "of " + std::to_string(block.picks()) + " picks and " + std::to_string(block.ends()) + " ends, from 1";
}

}  // namespace

Status set_number(Scene& scene, const std::string& text) {
    const std::string where = "--set " + text;
    const auto [name, digits] = split(text, '=');
    const std::optional<double> value = number_of<double>(digits);
    if (!value) return usage_error("write it as NAME=NUMBER, such as warp.strain=1.01", where);
    if (name == "friction") {
        scene.friction = *value;
        return {};
    }
    const auto [system, what] = split(name, '.');
    SystemScene* of = system == "warp" ? &scene.warp : system == "weft" ? &scene.weft : nullptr;
    std::optional<double>* number = nullptr;
    if (of != nullptr && what == "strain") number = &of->strain;
    if (of != nullptr && what == "stiffness") number = &of->stiffness_scale;
    if (of != nullptr && what == "radius") number = &of->radius_scale;
    if (number == nullptr)
        return usage_error("NAME is friction, or warp or weft with strain, stiffness or radius (the latter two are factors), such as weft.radius",
                           where);
    *number = *value;
    return {};
}

Status set_boundary(Scene& scene, sim::SimulationRequest& request, const std::string& text) {
    const Error trouble = usage_error("write it as x= or y= with periodic, frozen, free or relaxing:FORCE, such as y=relaxing:0.2 "
                                      "(N on each mm of rim)",
                                      "--boundary " + text);
    const auto [axis, kind] = split(text, '=');
    if (axis != "x" && axis != "y") return trouble;
    const std::size_t k = axis == "x" ? 0 : 1;
    Boundary& boundary = k == 0 ? scene.boundary_x : scene.boundary_y;
    request.relaxing_N_per_mm[k].reset();
    const auto [word, digits] = split(kind, ':');
    if (word == "relaxing") {
        const std::optional<double> force = digits.empty() ? std::optional(0.0) : number_of<double>(digits);
        if (!force || !(*force >= -1e6 && *force <= 1e6)) return trouble;
        boundary = Boundary::periodic;
        request.relaxing_N_per_mm[k] = force;
        return {};
    }
    if (kind == "periodic") return boundary = Boundary::periodic, Status();
    if (kind == "frozen") return boundary = Boundary::frozen, Status();
    if (kind == "free") return boundary = Boundary::free, Status();
    return trouble;
}

Status add_pin(Scene& scene, sim::SimulationRequest& request, const Block& block, const std::string& text) {
    const auto [what, digits] = split(text, ':');
    if (const auto crossing = crossing_of(text, block)) return request.held.push_back(*crossing), Status();
    const std::optional<std::size_t> number = number_of<std::size_t>(digits);
    const bool pick = what == "pick";
    if ((!pick && what != "end") || !number || *number < 1 || *number > (pick ? block.picks() : block.ends()))
        return usage_error("write it as pick:N, end:N or PICK,END " + size_of(block), "--pin " + text);
    scene.pins.push_back({pick, *number - 1});
    return {};
}

Status add_field(Scene& scene, const std::string& text) {
    if (text == "none") return scene.fields.clear(), Status();
    const Error trouble = usage_error("write it as sphere:X,Y,Z,RADIUS,STRENGTH (mm, and N on each mm of yarn at the centre), or none",
                                      "--field " + text);
    auto [kind, rest] = split(text, ':');
    std::array<double, 5> numbers{};
    for (double& number : numbers) {
        const auto [first, others] = split(rest, ',');
        const std::optional<double> value = number_of<double>(first);
        if (!value) return trouble;
        number = *value;
        rest = others;
    }
    if (kind != "sphere" || !rest.empty()) return trouble;
    scene.fields.push_back({{numbers[0], numbers[1], numbers[2]}, numbers[3], numbers[4]});
    return {};
}

Result<Region> parse_region(const std::string& text, const Block& block) {
    const Error trouble = usage_error("write it as picks:FIRST-LAST,ends:FIRST-LAST within " + std::to_string(block.picks()) +
                                          " picks and " + std::to_string(block.ends()) + " ends",
                                      "--region " + text);
    const auto range = [](const std::string& part, const std::string& name, std::size_t most) -> std::optional<std::array<std::size_t, 2>> {
        const auto [word, numbers] = split(part, ':');
        const auto [first, last] = split(numbers, '-');
        const std::optional<std::size_t> low = number_of<std::size_t>(first), high = number_of<std::size_t>(last);
        if (word != name || !low || !high || *low < 1 || *low > *high || *high > most) return {};
        return std::array{*low - 1, *high - 1};
    };
    const auto [first, second] = split(text, ',');
    const auto picks = range(first, "picks", block.picks()), ends = range(second, "ends", block.ends());
    if (!picks || !ends) return trouble;
    return Region{block.row_of_pick((*picks)[0]), block.row_of_pick((*picks)[1]), block.column_of_end((*ends)[0]),
                  block.column_of_end((*ends)[1])};
}

Result<std::vector<Flip>> parse_flips(const std::vector<std::string>& texts, const Block& block) {
    std::vector<Flip> flips;
    std::optional<Block> now;
    for (const std::string& text : texts) {
        const auto crossing = crossing_of(text, block);
        if (!crossing) return usage_error("write it as PICK,END " + size_of(block), "--flip " + text);
        const Block& before = now ? *now : block;
        const auto [pick, end] = *crossing;
        flips.push_back({pick, end, !before.weft_over(pick, end)});
        Result<Block> flipped = flip(before, pick, end);
        if (!flipped) return std::move(flipped).error().in("--flip " + text);
        now = std::move(flipped).value();
    }
    return flips;
}

std::string in_words(const std::vector<sim::PlanLine>& lines) {
    std::string text;
    for (const sim::PlanLine& line : lines) text += "  " + line.term + ": " + line.choice + " (" + line.reason + ")\n";
    return text;
}

}  // namespace weave::program
