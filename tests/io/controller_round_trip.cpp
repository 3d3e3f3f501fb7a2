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

void random_feeders(Random& random, Supply& supply, LoomProfile& profile) {
    profile.feeders = random.between(1, 6);
    profile.feeders_per_pick = random.between(1, 2);
    const bool has_words = profile.output == OutputFormat::ep;
    const std::size_t kind = random.between(0, has_words ? 3 : 1);
    if (kind == 0) return;
    std::vector<std::size_t> bits(32);
    std::iota(bits.begin(), bits.end(), std::size_t{0});
    random.shuffle(bits);
    if (kind == 1) {
        profile.feeder_encoding = FeederEncoding::hooks;
        profile.feeder_hooks = supply.take(profile.feeders);
    } else {
        profile.feeder_encoding = kind == 2 ? FeederEncoding::one_hot : FeederEncoding::binary;
        bits.resize(kind == 2 ? profile.feeders : 3);
        profile.feeder_hooks = bits;
    }
}

/// 40 hooks in a few areas, each use scattered over them.
LoomProfile random_loom(Random& random) {
    LoomProfile profile = bare_loom(formats[random.between(0, 2)], 40);
    profile.areas = random.coin() ? std::vector<HookArea>{{"f", 8}, {"g", 16}, {"h", 16}}
                                  : std::vector<HookArea>{{"all", 40}};
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
    std::vector<std::uint32_t> words;
};

FeederSet random_feeder_set(Random& random, const LoomProfile& profile) {
    const bool one = profile.feeder_encoding == FeederEncoding::binary || profile.feeders_per_pick == 1;
    std::set<std::uint32_t> set;
    for (std::size_t k = random.between(0, one ? 1 : 2); k > 0; --k)
        set.insert(static_cast<std::uint32_t>(random.between(1, profile.feeders) - 1));
    return {set.begin(), set.end()};
}

void set_feeders(const FeederSet& feeders, const LoomProfile& profile, std::string& hooks,
                 std::uint32_t& word) {
    for (const std::uint32_t feeder : feeders) {
        if (profile.feeder_encoding == FeederEncoding::hooks) hooks[profile.feeder_hooks[feeder]] = 'X';
        if (profile.feeder_encoding == FeederEncoding::one_hot) word |= 1U << profile.feeder_hooks[feeder];
        if (profile.feeder_encoding == FeederEncoding::binary) {
            for (std::size_t k = 0; k < 3; ++k)
                if (((feeder + 1) / (1U << k)) % 2 == 1) word |= 1U << profile.feeder_hooks[k];
        }
    }
}

/// The hooks of an end, worked out apart from the library: `body` holds the body hooks in order.
std::vector<std::size_t> places_of(const LoomProfile& profile, std::size_t end, std::size_t ends) {
    std::vector<std::size_t> body = profile.hook_of_end;
    for (const HookRange& range : profile.body) body.push_back(range.first);
    if (profile.hook_rule == HookRule::point) return {body[end], body[2 * ends - 2 - end]};
    std::vector<std::size_t> hooks;
    const std::size_t times = profile.hook_rule == HookRule::repeats ? profile.repeats : 1;
    for (std::size_t k = 0; k < times; ++k) hooks.push_back(body[end + k * ends]);
    return hooks;
}

Woven random_woven(Random& random, const LoomProfile& profile, std::size_t ends) {
    Woven woven;
    const std::size_t picks = random.between(1, 12);
    for (std::size_t pick = 0; pick < profile.lead_in_picks + picks; ++pick) {
        const bool lead_in = pick < profile.lead_in_picks;
        const std::size_t k = pick - profile.lead_in_picks;
        std::string hooks(40, '.'), lifted;
        for (std::size_t end = 0; end < ends; ++end) {
            lifted += random.coin() ? 'X' : '.';
            for (const std::size_t hook : places_of(profile, end, ends)) hooks[hook] = lifted.back();
        }
        for (const HookRange& on : profile.constant_on) hooks[on.first] = 'X';
        for (std::size_t n = 0; n < profile.selvedge.size() && !lead_in; ++n) {
            const std::string& row = profile.selvedge_weave[k % 2];
            if (row[n % row.size()] == '1') hooks[profile.selvedge[n].first] = 'X';
        }
        const bool take_up = random.coin();
        for (const std::size_t hook : profile.regulator_hooks) hooks[hook] = take_up ? '.' : 'X';
        std::uint32_t word = 0;
        const FeederSet feeders = random_feeder_set(random, profile);
        set_feeders(feeders, profile, hooks, word);
        woven.shed.push_back(hooks);
        woven.words.push_back(word);
        if (lead_in) continue;
        woven.ends.push_back(lifted);
        if (!profile.regulator_hooks.empty()) woven.take_up.push_back(take_up);
        if (profile.feeder_encoding != FeederEncoding::none) woven.feeders.push_back(feeders);
    }
    return woven;
}

std::string encode(const Woven& woven, const LoomProfile& profile) {
    switch (profile.output) {
        case OutputFormat::jc5:
            return jc5_bytes("NAME", "comment", woven.shed, profile);
        case OutputFormat::ep:
            return ep_bytes("NAME", woven.shed, woven.words, profile);
        default:
            return raw_bytes(woven.shed, profile);
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
        const bool judged = use == HookUse::cast_out || use == HookUse::constant_on;
        const bool changed = after->card != before.card || after->feeders != before.feeders ||
                             after->take_up != before.take_up || after->difference_count > 0;
        REQUIRE(changed == (judged || !in_lead_in));
        if (!changed || use == HookUse::feeder) return;
        REQUIRE((after->difference_count > 0 || use == HookUse::body || use == HookUse::regulator));
        for (const HookDifference& difference : after->differences) REQUIRE(difference.pick == pick);
    });
}
