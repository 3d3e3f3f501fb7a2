#include <weave/loom/profile.hpp>

#include <weave/core/file.hpp>
#include <weave/core/json_reader.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/design/plan_json.hpp>
#include <weave/loom/check.hpp>

#include <algorithm>
#include <array>

namespace weave {

namespace {

constexpr std::uint64_t most_profile_bytes = std::uint64_t{4} << 20;
constexpr std::int64_t last_hook = static_cast<std::int64_t>(most_hooks) - 1;
constexpr std::int64_t most_function_bytes = 8, last_function_bit = 8 * most_function_bytes - 1;
constexpr std::int64_t ep_function_bytes = 4;  // as observed
constexpr std::size_t most_ranges = 4096, most_selvedge_rows = 4096;
constexpr std::int64_t most_limit = 1'000'000'000;

const std::vector<std::string> rule_names{"straight", "point", "repeats", "list"};
const std::vector<std::string> output_names{"tiff", "png", "bmp", "jc5", "ep", "raw"};
const std::vector<std::string> encoding_names{"none", "one-hot", "binary", "hooks", "binary-hooks"};
const std::vector<std::string> severity_names{"off", "info", "warning", "error"};

template <class Choice>
Choice choice(JsonReader& reader, const std::string& key, const std::vector<std::string>& names,
              std::optional<Choice> fallback = {}) {
    std::optional<std::size_t> spare;
    if (fallback) spare = static_cast<std::size_t>(*fallback);
    return static_cast<Choice>(reader.choice(key, names, spare));
}

std::size_t count(JsonReader& reader, const std::string& key, std::int64_t low, std::int64_t high,
                  std::optional<std::int64_t> fallback = {}) {
    return static_cast<std::size_t>(reader.integer(key, low, high, fallback));
}

std::vector<std::size_t> numbers(JsonReader& reader, const std::string& key, std::int64_t high) {
    if (!reader.has(key)) return {};
    const auto values = reader.integers(key, 0, high);
    if (values.size() > most_hooks) {
        reader.fail("has more than " + std::to_string(most_hooks) + " entries", key);
        return {};
    }
    std::vector<std::size_t> found;
    found.reserve(values.size());
    for (const std::int64_t value : values) found.push_back(static_cast<std::size_t>(value));
    return found;
}

bool is_hook(const Json& value) {
    return value.is_number_integer() && value >= 0 && value <= last_hook;
}

/// A list of pairs [first, last], both from 0 and included.
std::vector<HookRange> ranges(JsonReader& reader, const std::string& key) {
    std::vector<HookRange> found;
    if (!reader.has(key)) return found;
    const Json& list = reader.raw(key);
    if (!list.is_array() || list.size() > most_ranges) {
        reader.fail("must be a list of at most " + std::to_string(most_ranges) + " pairs [first, last]", key);
        return found;
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Json& pair = list[i];
        if (!pair.is_array() || pair.size() != 2 || !is_hook(pair[0]) || !is_hook(pair[1]) ||
            pair[0] > pair[1]) {
            reader.fail("must be a pair [first, last] of hooks from 0 to " + std::to_string(last_hook),
                        indexed(key, i));
            return {};
        }
        found.push_back({pair[0].get<std::size_t>(), pair[1].get<std::size_t>()});
    }
    return found;
}

std::vector<std::string> selvedge_weave(JsonReader& reader) {
    const std::string key = "selvedge_weave";
    std::vector<std::string> rows;
    if (!reader.has(key)) return rows;
    const Json& list = reader.raw(key);
    if (!list.is_array() || list.empty() || list.size() > most_selvedge_rows) {
        reader.fail("must be a list of 1 to " + std::to_string(most_selvedge_rows) + " texts of 0 and 1",
                    key);
        return rows;
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string row = list[i].is_string() ? list[i].get<std::string>() : std::string();
        if (row.empty() || row.size() > most_hooks || row.find_first_not_of("01") != std::string::npos) {
            reader.fail("must be a text of 0 and 1, one for each selvedge hook", indexed(key, i));
            return {};
        }
        if (!rows.empty() && row.size() != rows.front().size()) {
            reader.fail("is not as long as the first row", indexed(key, i));
            return {};
        }
        rows.push_back(row);
    }
    return rows;
}

void read_areas(JsonReader& hooks, LoomProfile& profile) {
    auto areas = hooks.objects("areas");
    if (areas.empty() || areas.size() > 64) hooks.fail("must have 1 to 64 areas", "areas");
    for (auto& area : areas) {
        if (hooks.failed()) return;
        HookArea read;
        read.name = area.text("name", {}, 64);
        read.hooks = count(area, "hooks", 1, last_hook + 1);
        area.no_others();
        profile.total_hooks += read.hooks;
        profile.areas.push_back(std::move(read));
    }
    if (profile.total_hooks > most_hooks) {
        hooks.fail("add up to more than " + std::to_string(most_hooks) + " hooks", "areas");
    }
}

void read_harness(JsonReader& hooks, LoomProfile& profile) {
    profile.hook_rule = choice<HookRule>(hooks, "rule", rule_names, HookRule::straight);
    profile.body = ranges(hooks, "body");
    if (profile.hook_rule == HookRule::repeats) {
        profile.repeats = count(hooks, "repeats", 1, last_hook + 1);
    }
    if (profile.hook_rule == HookRule::list) {
        if (!hooks.has("hook_of_end")) hooks.fail("is missing: the rule is list", "hook_of_end");
        if (!profile.body.empty())
            hooks.fail("goes without: with the rule list, hook_of_end names the hooks", "body");
        profile.hook_of_end = numbers(hooks, "hook_of_end", last_hook);
    }
    profile.cast_out = ranges(hooks, "cast_out");
    profile.constant_on = ranges(hooks, "constant_on");
    profile.selvedge = ranges(hooks, "selvedge");
    profile.selvedge_weave = selvedge_weave(hooks);
    profile.regulator_hooks = numbers(hooks, "regulator", last_hook);
    if (profile.selvedge.empty() && !profile.selvedge_weave.empty()) {
        hooks.fail("needs selvedge hooks", "selvedge_weave");
    }
    hooks.no_others();
    if (!hooks.failed() && most_ends(profile) == 0) {
        hooks.fail("leaves no hook for an end", profile.hook_rule == HookRule::list ? "hook_of_end" : "body");
    }
}

void read_feeders(JsonReader feeders, LoomProfile& profile) {
    profile.feeders = count(feeders, "count", 1, 64);
    profile.feeder_encoding = choice<FeederEncoding>(feeders, "encoding", encoding_names);
    profile.feeders_per_pick = count(feeders, "per_pick", 1, 2, 1);
    const bool in_hooks = feeders_in_hooks(profile);
    profile.feeder_hooks = numbers(feeders, "places", in_hooks ? last_hook : last_function_bit);
    feeders.no_others();
    const std::size_t needed = feeder_places(profile);
    if (profile.feeder_hooks.empty() && !in_hooks && needed <= last_function_bit + 1) {
        for (std::size_t k = 0; k < needed; ++k) profile.feeder_hooks.push_back(k);
    }
    if (profile.feeder_hooks.size() != needed) {
        feeders.fail("must have " + std::to_string(needed) + " entries for this count and encoding",
                     "places");
    }
    auto sorted = profile.feeder_hooks;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        feeders.fail("names a place twice", "places");
}

void check_permutation(JsonReader& file, const LoomProfile& profile) {
    if (profile.hook_permutation.empty()) return;
    std::vector<bool> taken(profile.total_hooks);
    bool sound = profile.hook_permutation.size() == taken.size();
    for (const std::size_t place : profile.hook_permutation) {
        sound = sound && place < taken.size() && !taken[place];
        if (sound) taken[place] = true;
    }
    if (!sound) file.fail("must name every place from 0 to the last hook exactly once", "hook_permutation");
}

/// What a picture cannot say, and what only a picture can.
void check_output(JsonReader& file, const LoomProfile& profile) {
    if (takes_picture(profile.output)) {
        if (profile.lead_in_picks > 0)
            file.fail("needs jc5, ep or raw: a picture has the design's picks alone", "lead_in_picks");
    } else if (!profile.converts_to.empty()) {
        file.fail("needs a picture: tiff, png or bmp", "converts_to");
    }
}

void read_file_part(JsonReader file, LoomProfile& profile) {
    profile.output = choice<OutputFormat>(file, "output", output_names);
    profile.lifted_is_one = file.boolean("lifted_is_one", true);
    profile.least_bit_first = file.boolean("least_bit_first", true);
    profile.pick_1_at_bottom = file.boolean("pick_1_at_bottom", true);
    profile.end_1_at_left = file.boolean("end_1_at_left", true);
    profile.name_limit = count(file, "name_limit", 0, 255, 8);
    profile.lead_in_picks = count(file, "lead_in_picks", 0, 1'000'000, 0);
    const bool is_ep = profile.output == OutputFormat::ep, is_raw = profile.output == OutputFormat::raw;
    profile.function_bytes = count(file, "function_bytes", 0, is_ep || is_raw ? most_function_bytes : 0,
                                   is_ep ? ep_function_bytes : 0);
    profile.areas_on_bytes = file.boolean("areas_on_bytes", true);
    profile.converts_to = file.text("converts_to", "", 64);
    profile.hook_permutation = numbers(file, "hook_permutation", last_hook);
    file.no_others();
    if (file.failed()) return;
    check_output(file, profile);
    check_permutation(file, profile);
}

void read_limits(JsonReader limits, LoomProfile& profile) {
    LoomLimits& read = profile.limits;
    read.float_face = count(limits, "float_face", 0, most_limit, 0);
    read.float_back = count(limits, "float_back", 0, most_limit, 0);
    read.lift_difference = limits.optional_number("lift_difference", {0, 1});
    read.lift_share = limits.optional_number("lift_share", {0, 1});
    read.picks = count(limits, "picks", 0, most_limit, 0);
    read.take_up_difference = limits.optional_number("take_up_difference", {0, 100});
    read.reed_width_mm = limits.optional_number("reed_width_mm", {1, 1e5});
    limits.no_others();
}

void read_severities(JsonReader& reader, LoomProfile& profile) {
    JsonReader severities = reader.object("severities", true);
    std::vector<std::string> named;
    for (auto it = severities.json().begin(); it != severities.json().end(); ++it) named.push_back(it.key());
    for (const std::string& rule : named) {
        const bool known =
            std::any_of(rules().begin(), rules().end(), [&](const Rule& r) { return r.id == rule; });
        if (!known) return severities.fail("is not a rule", rule);
        profile.severities[rule] = choice<Severity>(severities, rule, severity_names);
    }
}

/// A controller's file has a bit for every place that a feeder is selected by; a picture has none, and the
/// pick table tells.
void check_function_bits(JsonReader& reader, const LoomProfile& profile) {
    const bool in_bits = profile.feeder_encoding == FeederEncoding::one_hot ||
                         profile.feeder_encoding == FeederEncoding::binary;
    if (!in_bits || takes_picture(profile.output) || reader.failed()) return;
    for (const std::size_t bit : profile.feeder_hooks) {
        if (bit < 8 * profile.function_bytes) continue;
        return reader.fail("names function bit " + std::to_string(bit) + ", but the file has " +
                               counted(profile.function_bytes, "function byte"),
                           "feeders.places");
    }
}

/// Marks every hook with the member that uses it, and finds the first that two members claim.
class HookClaims {
  public:
    HookClaims(JsonReader& reader, std::size_t hooks) : m_reader(reader), m_claims(hooks) {}

    void claim(const std::string& member, std::size_t hook) {
        if (hook >= m_claims.size()) {
            return m_reader.fail("names hook " + std::to_string(hook) + ", but the last hook is " +
                                     std::to_string(m_claims.size() - 1),
                                 member);
        }
        if (!m_claims[hook].empty() && m_claims[hook] != member) {
            return m_reader.fail(
                "claims hook " + std::to_string(hook) + ", which belongs to " + m_claims[hook], member);
        }
        m_claims[hook] = member;
    }

    void claim(const std::string& member, const std::vector<HookRange>& ranges) {
        for (const auto& range : ranges) {
            for (std::size_t hook = range.first; hook <= range.last && !m_reader.failed(); ++hook) {
                if (hook < m_claims.size() && m_claims[hook] == member) {
                    return m_reader.fail("names hook " + std::to_string(hook) + " twice", member);
                }
                claim(member, hook);
            }
        }
    }

    void claim(const std::string& member, const std::vector<std::size_t>& hooks) {
        for (std::size_t i = 0; i < hooks.size() && !m_reader.failed(); ++i) claim(member, hooks[i]);
    }

  private:
    JsonReader& m_reader;
    std::vector<std::string> m_claims;
};

void check_claims(JsonReader& reader, const LoomProfile& profile) {
    if (reader.failed()) return;
    HookClaims claims(reader, profile.total_hooks);
    claims.claim("hooks.body", profile.body);
    claims.claim("hooks.hook_of_end", profile.hook_of_end);
    claims.claim("hooks.cast_out", profile.cast_out);
    claims.claim("hooks.constant_on", profile.constant_on);
    claims.claim("hooks.selvedge", profile.selvedge);
    claims.claim("hooks.regulator", profile.regulator_hooks);
    if (feeders_in_hooks(profile)) claims.claim("feeders.places", profile.feeder_hooks);
}

void read_heading(JsonReader& reader, LoomProfile& profile) {
    static_cast<void>(reader.raw("format"));
    const std::int64_t version = reader.integer("version", 1, most_limit);
    if (version > 1) {
        reader.fail("is " + std::to_string(version) + ", newer than this program, which reads version 1",
                    "version");
    }
    profile.name = reader.text("name", {}, 256);
    if (profile.name.empty()) reader.fail("must not be empty", "name");
    profile.maker = reader.text("maker", "", 256);
    profile.version = reader.text("revision", "1", 64);
    profile.notes = reader.text("notes", "");
    profile.insertion = choice<Insertion>(reader, "insertion", insertion_kinds());
    profile.density_ends_per_cm = reader.optional_number("density_ends_per_cm", {0.01, 1000});
}

/// The document of a profile, told from other kinds of files by what they say they are.
Result<Json> profile_document(std::string_view text) {
    auto json = parse_json(text);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (!json && first != std::string_view::npos && text[first] != '{')
        return bad_input("is no profile of a loom, which would begin with {");
    if (!json) return json;
    const Json format = json->is_object() ? json->value("format", Json()) : Json();
    if (format == "weave") return bad_input("is a design, no profile of a loom");
    if (format != "weave-loom")
        return bad_input("must be weave-loom, as a profile of a loom has it", "format");
    return json;
}

}  // namespace

const std::string& name_of(OutputFormat output) {
    return output_names[static_cast<std::size_t>(output)];
}

Result<LoomProfile> read_profile(std::string_view text) {
    if (text.size() > most_profile_bytes) {
        return bad_input("a loom profile may have at most " + std::to_string(most_profile_bytes) + " bytes");
    }
    WEAVE_TRY(const Json json, profile_document(text));
    JsonReader reader(json, "");
    LoomProfile profile;
    read_heading(reader, profile);
    JsonReader hooks = reader.object("hooks");
    if (!reader.failed()) read_areas(hooks, profile);
    if (!reader.failed()) read_harness(hooks, profile);
    read_feeders(reader.object("feeders"), profile);
    read_file_part(reader.object("file"), profile);
    read_limits(reader.object("limits", true), profile);
    read_severities(reader, profile);
    reader.no_others();
    check_function_bits(reader, profile);
    check_claims(reader, profile);
    WEAVE_CHECK_OK(reader.status());
    profile.sha256 = sha256_hex(canonical_json(json));
    return profile;
}

Result<LoomProfile> load_profile(const std::filesystem::path& path) {
    WEAVE_TRY(const std::string text, read_file(path, most_profile_bytes));
    auto profile = read_profile(text);
    if (!profile) return std::move(profile).error().in(path.string());
    return profile;
}

}  // namespace weave
