// Random cards on random looms, encoded by the tests' own encoder, come back as they were.

#include "controller_case.hpp"

#include <numeric>
#include <set>
#include <support/controller_bytes.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

constexpr OutputFormat formats[] = {OutputFormat::jc5, OutputFormat::ep, OutputFormat::raw};

/// Takes hooks one after the other from a random order of all.
struct Supply {
    std::vector<std::size_t> hooks;
    std::vector<std::size_t> take(std::size_t count) {
        std::vector<std::size_t> taken(hooks.end() - static_cast<std::ptrdiff_t>(count), hooks.end());
        hooks.resize(hooks.size() - count);
        return taken;
    }
    std::vector<HookRange> ranges(std::size_t count) {
        std::vector<HookRange> found;
        for (const std::size_t hook : take(count)) found.push_back({hook, hook});
        return found;
    }
};

bool is_number(FeederEncoding encoding) {
    return encoding == FeederEncoding::binary || encoding == FeederEncoding::binary_hooks;
}

void random_feeders(Random& random, Supply& supply, LoomProfile& profile) {
    profile.feeders = random.between(1, 6);
    profile.feeders_per_pick = random.between(1, 2);
    std::vector<FeederEncoding> kinds{FeederEncoding::none, FeederEncoding::hooks,
                                      FeederEncoding::binary_hooks};
    if (profile.function_bytes > 0)
        kinds.insert(kinds.end(), {FeederEncoding::one_hot, FeederEncoding::binary});
    profile.feeder_encoding = kinds[random.between(0, kinds.size() - 1)];
    if (profile.feeder_encoding == FeederEncoding::none) return;
    const std::size_t places = is_number(profile.feeder_encoding) ? 3 : profile.feeders;
    if (feeders_in_hooks(profile)) {
        profile.feeder_hooks = supply.take(places);
        return;
    }
    profile.feeder_hooks.resize(8 * profile.function_bytes);
    std::iota(profile.feeder_hooks.begin(), profile.feeder_hooks.end(), std::size_t{0});
    random.shuffle(profile.feeder_hooks);
    profile.feeder_hooks.resize(places);
}

/// 40 hooks in a few areas, each use scattered over them.
LoomProfile random_loom(Random& random) {
    LoomProfile profile = bare_loom(formats[random.between(0, 2)], 40);
    profile.areas =
        std::vector<std::vector<HookArea>>{{{"all", 40}},
                                           {{"f", 8}, {"g", 16}, {"h", 16}},
                                           {{"f", 3}, {"g", 17}, {"h", 20}}}[random.between(0, 2)];
    profile.areas_on_bytes = random.coin();
    if (profile.output == OutputFormat::ep) profile.function_bytes = random.coin() ? 4 : random.between(0, 8);
    if (profile.output == OutputFormat::raw)
        profile.function_bytes = random.coin() ? 0 : random.between(1, 8);
    profile.end_1_at_left = random.coin();
    profile.lifted_is_one = random.coin();
    profile.least_bit_first = random.coin();
    profile.pick_1_at_bottom = random.coin();
    profile.lead_in_picks = random.coin() ? 0 : random.between(1, 3);
    Supply supply;
    supply.hooks.resize(40);
    std::iota(supply.hooks.begin(), supply.hooks.end(), std::size_t{0});
    random.shuffle(supply.hooks);
    if (random.coin()) {
        profile.hook_permutation = supply.hooks;
        random.shuffle(supply.hooks);
    }
    random_feeders(random, supply, profile);
    profile.cast_out = supply.ranges(random.between(0, 3));
    profile.constant_on = supply.ranges(random.between(0, 3));
    profile.regulator_hooks = supply.take(random.between(0, 2));
    profile.selvedge = supply.ranges(random.between(0, 4));
    if (!profile.selvedge.empty()) profile.selvedge_weave = {random.coin() ? "01" : "001", "110"};
    if (profile.selvedge_weave.size() == 2 && profile.selvedge_weave[0].size() == 2)
        profile.selvedge_weave[1] = "10";
    profile.hook_rule = static_cast<HookRule>(random.between(0, 3));
    profile.body = supply.ranges(random.between(4, 16));
    if (profile.hook_rule == HookRule::repeats) profile.repeats = random.between(1, 4);
    if (profile.hook_rule == HookRule::list) {
        for (const HookRange& range : profile.body) profile.hook_of_end.push_back(range.first);
        profile.body.clear();
    }
    return profile;
}

/// What is to be woven, and the sheds that weave it.
struct Woven {
    std::vector<std::string> ends;  ///< lifted ends of each pick
    std::vector<FeederSet> feeders;
    std::vector<bool> take_up;
    Shed shed;
    Words words;
};

FeederSet random_feeder_set(Random& random, const LoomProfile& profile) {
    const bool one = is_number(profile.feeder_encoding) || profile.feeders_per_pick == 1;
    std::set<std::uint32_t> set;
    for (std::size_t k = random.between(0, one ? 1 : 2); k > 0; --k)
        set.insert(static_cast<std::uint32_t>(random.between(1, profile.feeders) - 1));
    return {set.begin(), set.end()};
}

void set_feeders(const FeederSet& feeders, const LoomProfile& profile, std::string& hooks,
                 std::uint64_t& word) {
    for (const std::uint32_t feeder : feeders) {
        for (std::size_t k = 0; k < profile.feeder_hooks.size(); ++k) {
            const std::size_t place = profile.feeder_hooks[k];
            const bool set =
                is_number(profile.feeder_encoding) ? ((feeder + 1) / (1U << k)) % 2 == 1 : feeder == k;
            if (!set) continue;
            if (feeders_in_hooks(profile))
                hooks[place] = 'X';
            else
                word |= std::uint64_t{1} << place;
        }
    }
}

/// The hooks of an end, worked out apart from the library: `body` holds the body hooks in order.
std::vector<std::size_t> places_of(const LoomProfile& profile, std::size_t end, std::size_t ends) {
    std::vector<std::size_t> body = profile.hook_of_end;
    for (const HookRange& range : profile.body) body.push_back(range.first);
    if (!profile.end_1_at_left && profile.hook_rule != HookRule::list) std::reverse(body.begin(), body.end());
    if (profile.hook_rule == HookRule::point) return {body[end], body[2 * ends - 2 - end]};
    std::vector<std::size_t> hooks;
    const std::size_t times = profile.hook_rule == HookRule::repeats ? profile.repeats : 1;
    for (std::size_t k = 0; k < times; ++k) hooks.push_back(body[end + k * ends]);
    return hooks;
}

/// The sheds of one pick of the design, from 0.
void add_pick(Random& random, const LoomProfile& profile, std::size_t ends, std::size_t k, Woven& woven) {
    std::string hooks(40, '.'), lifted;
    for (std::size_t end = 0; end < ends; ++end) {
        lifted += random.coin() ? 'X' : '.';
        for (const std::size_t hook : places_of(profile, end, ends)) hooks[hook] = lifted.back();
    }
    for (const HookRange& on : profile.constant_on) hooks[on.first] = 'X';
    for (std::size_t n = 0; n < profile.selvedge.size(); ++n) {
        const std::string& row = profile.selvedge_weave[k % 2];
        if (row[n % row.size()] == '1') hooks[profile.selvedge[n].first] = 'X';
    }
    const bool take_up = random.coin();
    for (const std::size_t hook : profile.regulator_hooks) hooks[hook] = take_up ? '.' : 'X';
    std::uint64_t word = 0;
    const FeederSet feeders = random_feeder_set(random, profile);
    set_feeders(feeders, profile, hooks, word);
    woven.shed.push_back(hooks);
    woven.words.push_back(word);
    woven.ends.push_back(lifted);
    if (!profile.regulator_hooks.empty()) woven.take_up.push_back(take_up);
    if (profile.feeder_encoding != FeederEncoding::none) woven.feeders.push_back(feeders);
}

Woven random_woven(Random& random, const LoomProfile& profile, std::size_t ends) {
    Woven woven;
    for (std::size_t pick = 0; pick < profile.lead_in_picks; ++pick) {
        std::string hooks(40, '.');
        for (const HookRange& on : profile.constant_on) hooks[on.first] = 'X';
        woven.shed.push_back(hooks);
        woven.words.push_back(0);
    }
    const std::size_t picks = random.between(1, 12);
    for (std::size_t k = 0; k < picks; ++k) add_pick(random, profile, ends, k, woven);
    return woven;
}

std::string encode(const Woven& woven, const LoomProfile& profile) {
    switch (profile.output) {
        case OutputFormat::jc5:
            return jc5_bytes("NAME", "comment", woven.shed, profile);
        case OutputFormat::ep:
            return ep_bytes("NAME", woven.shed, woven.words, profile);
        default:
            return raw_bytes(woven.shed, profile, woven.words);
    }
}

}  // namespace

TEST_CASE("a random card on a random loom comes back from its controller file") {
    for_all([](Random& random) {
        const LoomProfile profile = random_loom(random);
        const std::size_t ends = random.between(1, most_ends(profile));
        const Woven woven = random_woven(random, profile, ends);
        const std::string bytes = encode(woven, profile);
        const Result<ControllerFile> file = read_controller_file(bytes, profile);
        REQUIRE(file);
        REQUIRE(file->warnings.empty());
        REQUIRE(file->picks() == woven.shed.size());
        for (std::size_t pick = 0; pick < file->picks(); ++pick)
            REQUIRE(shed_of(*file, pick) == woven.shed[pick]);
        const Result<ControllerCard> card = card_of(*file, profile, ends);
        REQUIRE(card);
        REQUIRE(card->difference_count == 0);
        REQUIRE(card->warnings.empty());
        REQUIRE(card->feeders == woven.feeders);
        REQUIRE(card->take_up == woven.take_up);
        REQUIRE(card->card.picks() == woven.ends.size());
        for (std::size_t pick = 0; pick < woven.ends.size(); ++pick)
            for (std::size_t end = 0; end < ends; ++end)
                REQUIRE(card->card.weft_over(pick, end) == (woven.ends[pick][end] == '.'));
    });
}

TEST_CASE("one flipped hook bit changes one crossing, or is told, and nothing else") {
    for_all([](Random& random) {
        const LoomProfile profile = random_loom(random);
        const std::size_t ends = random.between(1, most_ends(profile));
        Woven woven = random_woven(random, profile, ends);
        const ControllerCard before =
            *card_of(*read_controller_file(encode(woven, profile), profile), profile, ends);
        const std::size_t pick = random.between(1, woven.shed.size()) - 1, hook = random.between(0, 39);
        char& bit = woven.shed[pick][hook];
        bit = bit == 'X' ? '.' : 'X';
        const auto after = card_of(*read_controller_file(encode(woven, profile), profile), profile, ends);
        if (!after) return;  // three feeders at once
        const HookUse use = hook_uses(profile)[hook];
        const bool in_lead_in = pick < profile.lead_in_picks;
        const bool changed = after->card != before.card || after->feeders != before.feeders ||
                             after->take_up != before.take_up || after->difference_count > 0;
        REQUIRE(changed);
        if (in_lead_in) REQUIRE(after->difference_count == 1);
        if (use == HookUse::feeder && !in_lead_in) return;
        REQUIRE((after->difference_count > 0 || use == HookUse::body || use == HookUse::regulator));
        for (const HookDifference& difference : after->differences) REQUIRE(difference.pick == pick);
    });
}
