#include <weave/design/plan_json.hpp>

#include <weave/design/design.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace weave {

namespace {

constexpr Range factor_range{1e-9, 1e9};
constexpr std::int64_t scene_version = 1;

const std::vector<std::string> boundary_names{"periodic", "frozen", "free"};
const std::vector<std::string> weft_mode_names{"periodic", "wraparound"};
const std::vector<std::string> pin_names{"end", "pick"};

template <class Enum>
const std::string& name_of(const std::vector<std::string>& names, Enum value) {
    return names[static_cast<std::size_t>(value)];
}

template <class Enum>
Enum enum_member(JsonReader& reader, const std::string& key, const std::vector<std::string>& names,
                 Enum fallback) {
    return static_cast<Enum>(reader.choice(key, names, static_cast<std::size_t>(fallback)));
}

Json to_json(const YarnType& yarn) {
    return {{"name", yarn.name},
            {"colour", to_text(yarn.colour)},
            {"radius_mm", yarn.radius_mm},
            {"linear_density_tex", yarn.linear_density_tex},
            {"stretch_stiffness_N", yarn.stretch_stiffness_N},
            {"bending_stiffness_N_mm2", yarn.bending_stiffness_N_mm2},
            {"contact_stiffness_N_mm2", yarn.contact_stiffness_N_mm2}};
}

Json to_json(const std::vector<YarnType>& yarns) {
    Json list = Json::array();
    for (const YarnType& yarn : yarns) list.push_back(to_json(yarn));
    return list;
}

std::vector<YarnType> yarns_member(JsonReader& reader, const std::vector<YarnType>& fallback) {
    if (!reader.has("yarns")) return fallback;
    const YarnType standard = fallback.front();
    std::vector<YarnType> yarns;
    for (JsonReader& item : reader.objects("yarns")) {
        YarnType& yarn = yarns.emplace_back();
        yarn.name = item.text("name", "", longest_yarn_name);
        yarn.colour = item.colour("colour", standard.colour);
        yarn.radius_mm = item.number("radius_mm", {1e-4, 100}, standard.radius_mm);
        yarn.linear_density_tex = item.number("linear_density_tex", {1e-3, 1e7}, standard.linear_density_tex);
        yarn.stretch_stiffness_N =
            item.number("stretch_stiffness_N", {1e-9, 1e12}, standard.stretch_stiffness_N);
        yarn.bending_stiffness_N_mm2 =
            item.number("bending_stiffness_N_mm2", {0, 1e12}, standard.bending_stiffness_N_mm2);
        yarn.contact_stiffness_N_mm2 =
            item.number("contact_stiffness_N_mm2", {1e-9, 1e12}, standard.contact_stiffness_N_mm2);
        item.no_others();
    }
    if (yarns.empty()) {
        reader.fail("needs at least one yarn", "yarns");
        return fallback;
    }
    return yarns;
}

/// A list per pick in the words of a sequence: `0*3 0+1 -`, with runs.
std::string feeder_text(const std::vector<FeederSet>& order) {
    std::string text;
    for (std::size_t i = 0; i < order.size();) {
        std::size_t next = i + 1;
        while (next < order.size() && order[next] == order[i]) ++next;
        std::string word = order[i].empty() ? "-" : std::to_string(order[i][0]);
        if (order[i].size() == 2) word += "+" + std::to_string(order[i][1]);
        if (next - i > 1) word += "*" + std::to_string(next - i);
        text += (text.empty() ? "" : " ") + word;
        i = next;
    }
    return text;
}

/// One word of a feeder order without its run: `-`, `2` or `0+1`.
bool parse_feeders(std::string_view word, FeederSet& set) {
    if (word == "-") return true;
    while (true) {
        std::uint32_t number = 0;
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (code != std::errc{}) return false;
        set.push_back(number);
        word.remove_prefix(static_cast<std::size_t>(end - word.data()));
        if (word.empty()) return true;
        if (word.front() != '+' || set.size() == 2) return false;
        word.remove_prefix(1);
    }
}

std::vector<FeederSet> feeder_order_member(JsonReader& reader) {
    constexpr std::size_t longest = longest_sequence;
    std::vector<FeederSet> order;
    const std::string text = reader.text("feeder_order", "0", std::size_t{1} << 24);
    std::size_t at = 0;
    while ((at = text.find_first_not_of(' ', at)) != std::string::npos) {
        const std::string_view word = std::string_view(text).substr(at, text.find(' ', at) - at);
        at += word.size();
        const std::size_t star = std::min(word.find('*'), word.size());
        std::uint32_t count = 1;
        FeederSet set;
        bool fine = parse_feeders(word.substr(0, star), set);
        if (fine && star < word.size()) {
            const auto [end, code] =
                std::from_chars(word.data() + star + 1, word.data() + word.size(), count);
            fine = code == std::errc{} && end == word.data() + word.size() && count > 0;
        }
        if (!fine) {
            reader.fail(
                "'" + std::string(word.substr(0, 40)) + "' is not a pick's feeders such as 0, 0+1, - or 0*12",
                "feeder_order");
            return {{0}};
        }
        if (count > longest - order.size()) {
            reader.fail("is longer than " + std::to_string(longest) + " picks", "feeder_order");
            return {{0}};
        }
        order.insert(order.end(), count, set);
    }
    return order;
}

Json to_json(const SystemScene& system) {
    Json json = Json::object();
    if (system.strain) json["strain"] = *system.strain;
    if (system.stiffness_scale) json["stiffness_scale"] = *system.stiffness_scale;
    if (system.radius_scale) json["radius_scale"] = *system.radius_scale;
    return json;
}

SystemScene system_scene(JsonReader reader) {
    SystemScene system;
    system.strain = reader.optional_number("strain", {1, 2});
    system.stiffness_scale = reader.optional_number("stiffness_scale", factor_range);
    system.radius_scale = reader.optional_number("radius_scale", factor_range);
    reader.no_others();
    return system;
}

void read_fields(JsonReader& reader, Scene& scene) {
    for (JsonReader& item : reader.objects("fields", true)) {
        ForceField& field = scene.fields.emplace_back();
        const Json& centre = item.raw("centre_mm");
        const bool three =
            centre.is_array() && centre.size() == 3 &&
            std::all_of(centre.begin(), centre.end(), [](const Json& x) { return x.is_number(); });
        if (three && std::all_of(centre.begin(), centre.end(),
                                 [](const Json& x) { return std::abs(x.get<double>()) <= 1e9; })) {
            field.centre_mm = centre.get<std::array<double, 3>>();
        } else {
            item.fail("must be three numbers from -1e9 to 1e9, in mm", "centre_mm");
        }
        field.radius_mm = item.number("radius_mm", {1e-6, 1e6});
        field.strength_N_per_mm = item.number("strength_N_per_mm", {-1e9, 1e9});
        item.no_others();
    }
}

}  // namespace

Sequence sequence_member(JsonReader& reader, const std::string& key, std::size_t below,
                         const Sequence& fallback) {
    if (!reader.has(key)) return fallback;
    const Result<Sequence> sequence =
        parse_sequence(reader.text(key, {}, std::size_t{1} << 24), static_cast<std::uint32_t>(below));
    if (sequence) return *sequence;
    reader.fail(sequence.error().message, key);
    return fallback;
}

Json to_json(const WarpPlan& warp) {
    Json beams = Json::array(), colours = Json::array();
    for (const Beam& beam : warp.beams) beams.push_back({{"name", beam.name}});
    for (const Colour colour : warp.colours) colours.push_back(to_text(colour));
    return {{"yarns", to_json(warp.yarns)},
            {"order", to_text(warp.order)},
            {"beams", beams},
            {"beam_order", to_text(warp.beam_order)},
            {"colours", colours},
            {"colour_order", to_text(warp.colour_order)},
            {"density_ends_per_cm", warp.density_ends_per_cm},
            {"ends_per_dent", warp.ends_per_dent}};
}

WarpPlan warp_from_json(JsonReader reader) {
    const WarpPlan standard = default_warp();
    WarpPlan warp = standard;
    warp.yarns = yarns_member(reader, standard.yarns);
    if (reader.has("beams")) {
        warp.beams.clear();
        for (JsonReader& item : reader.objects("beams")) {
            warp.beams.push_back({item.text("name", "", longest_yarn_name)});
            item.no_others();
        }
        if (warp.beams.empty()) reader.fail("needs at least one beam", "beams");
    }
    const Json& colours = reader.raw("colours");
    if (!colours.is_null() && !colours.is_array()) reader.fail("must be a list of colours", "colours");
    for (std::size_t k = 0; colours.is_array() && k < colours.size(); ++k) {
        const Result<Colour> colour =
            parse_colour(colours[k].is_string() ? colours[k].get<std::string>() : "");
        if (!colour) reader.fail(colour.error().message, "colours[" + std::to_string(k) + "]");
        warp.colours.push_back(colour ? *colour : Colour{});
    }
    warp.order = sequence_member(reader, "order", warp.yarns.size(), standard.order);
    warp.beam_order = sequence_member(reader, "beam_order", warp.beams.size(), standard.beam_order);
    warp.colour_order =
        sequence_member(reader, "colour_order", warp.colours.size() + 1, standard.colour_order);
    warp.density_ends_per_cm =
        reader.number("density_ends_per_cm", {0.01, 1e4}, standard.density_ends_per_cm);
    warp.ends_per_dent =
        static_cast<std::uint32_t>(reader.integer("ends_per_dent", 1, 1000, standard.ends_per_dent));
    reader.no_others();
    return warp;
}

Json to_json(const WeftPlan& weft) {
    Json feeders = Json::array();
    for (const Feeder& feeder : weft.feeders)
        feeders.push_back({{"name", feeder.name}, {"yarn", feeder.yarn}});
    Json json{{"yarns", to_json(weft.yarns)},
              {"feeders", feeders},
              {"feeder_order", feeder_text(weft.feeder_order)}};
    if (!weft.directions.empty()) {
        Sequence directions{{}};
        for (const Direction direction : weft.directions)
            directions.once.push_back(static_cast<std::uint32_t>(direction));
        json["directions"] = to_text(directions);
    }
    if (!weft.take_up.empty()) {
        Sequence take_up{{}};
        for (const bool advances : weft.take_up) take_up.once.push_back(advances ? 1 : 0);
        json["take_up"] = to_text(take_up);
    }
    json["density_picks_per_cm"] = weft.density_picks_per_cm;
    return json;
}

WeftPlan weft_from_json(JsonReader reader) {
    const WeftPlan standard = default_weft();
    WeftPlan weft = standard;
    weft.yarns = yarns_member(reader, standard.yarns);
    if (reader.has("feeders")) {
        weft.feeders.clear();
        for (JsonReader& item : reader.objects("feeders")) {
            const auto last = static_cast<std::int64_t>(weft.yarns.size()) - 1;
            const std::string name = item.text("name", "", longest_yarn_name);
            weft.feeders.push_back({name, static_cast<std::uint32_t>(item.integer("yarn", 0, last, 0))});
            item.no_others();
        }
    }
    weft.feeder_order = feeder_order_member(reader);
    for (const std::uint32_t way : sequence_member(reader, "directions", 2, Sequence{{}}).once) {
        weft.directions.push_back(static_cast<Direction>(way));
    }
    for (const std::uint32_t advances : sequence_member(reader, "take_up", 2, Sequence{{}}).once) {
        weft.take_up.push_back(advances == 1);
    }
    weft.density_picks_per_cm =
        reader.number("density_picks_per_cm", {0.01, 1e4}, standard.density_picks_per_cm);
    reader.no_others();
    return weft;
}

const std::vector<std::string>& insertion_kinds() {
    static const std::vector<std::string> names{"shuttle", "rapier", "air-jet"};
    return names;
}

Json to_json(const Scene& scene) {
    Json json{{"version", scene_version}};
    if (scene.dx_mm) json["dx_mm"] = *scene.dx_mm;
    if (scene.dy_mm) json["dy_mm"] = *scene.dy_mm;
    if (scene.dz_mm) json["dz_mm"] = *scene.dz_mm;
    json["boundary_x"] = name_of(boundary_names, scene.boundary_x);
    json["boundary_y"] = name_of(boundary_names, scene.boundary_y);
    json["weft_mode"] = name_of(weft_mode_names, scene.weft_mode);
    json["insertion"] = name_of(insertion_kinds(), scene.insertion);
    json["warp"] = to_json(scene.warp);
    json["weft"] = to_json(scene.weft);
    json["pins"] = Json::array();
    for (const Pin& pin : scene.pins) {
        json["pins"].push_back({{"system", pin_names[pin.is_pick ? 1 : 0]}, {"number", pin.number}});
    }
    json["fields"] = Json::array();
    for (const ForceField& field : scene.fields) {
        json["fields"].push_back({{"centre_mm", field.centre_mm},
                                  {"radius_mm", field.radius_mm},
                                  {"strength_N_per_mm", field.strength_N_per_mm}});
    }
    json["friction"] = scene.friction;
    json["gravity"] = scene.gravity;
    return json;
}

Scene scene_from_json(JsonReader reader) {
    Scene scene;
    if (reader.integer("version", 1, INT64_MAX, scene_version) > scene_version) {
        reader.fail(
            "is newer than this program, which knows scenes up to version " + std::to_string(scene_version),
            "version");
    }
    scene.dx_mm = reader.optional_number("dx_mm", {1e-6, 1e6});
    scene.dy_mm = reader.optional_number("dy_mm", {1e-6, 1e6});
    scene.dz_mm = reader.optional_number("dz_mm", {1e-6, 1e6});
    scene.boundary_x = enum_member(reader, "boundary_x", boundary_names, scene.boundary_x);
    scene.boundary_y = enum_member(reader, "boundary_y", boundary_names, scene.boundary_y);
    scene.weft_mode = enum_member(reader, "weft_mode", weft_mode_names, scene.weft_mode);
    scene.insertion = enum_member(reader, "insertion", insertion_kinds(), scene.insertion);
    scene.warp = system_scene(reader.object("warp", true));
    scene.weft = system_scene(reader.object("weft", true));
    for (JsonReader& item : reader.objects("pins", true)) {
        const bool is_pick = item.choice("system", pin_names) == 1;
        const auto number = static_cast<std::size_t>(item.integer("number", 0, most_yarn_number));
        scene.pins.push_back({is_pick, number});
        item.no_others();
    }
    read_fields(reader, scene);
    scene.friction = reader.number("friction", {0, 100}, 0);
    scene.gravity = reader.boolean("gravity", false);
    reader.no_others();
    return scene;
}

}  // namespace weave
