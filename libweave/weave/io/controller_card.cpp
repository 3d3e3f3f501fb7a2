#include <weave/core/text.hpp>
#include <weave/io/controller_reader.hpp>

#include <algorithm>
#include <array>

namespace weave {

namespace {

std::string person(std::size_t number) {
    return std::to_string(number + 1);
}

/// What a file is held to, and what came out so far.
struct Reading {
    const ControllerFile& file;
    const LoomProfile& profile;
    std::size_t ends = 0;
    ControllerCard made;
    std::array<std::size_t, 6> found{};  ///< differences of each use

    [[nodiscard]] std::size_t first_pick() const { return profile.lead_in_picks; }

    void differs(const HookDifference& difference) {
        ++made.difference_count;
        if (++found[static_cast<std::size_t>(difference.use)] <= most_listed_differences)
            made.differences.push_back(difference);
    }

    /// Tells each of these hooks that does not do what `wanted(pick, place in the list)` says.
    template <class Wanted>
    void hold(const std::vector<std::size_t>& hooks, HookUse use, std::size_t from, Wanted wanted) {
        for (std::size_t pick = from; pick < file.picks(); ++pick) {
            for (std::size_t place = 0; place < hooks.size(); ++place) {
                const bool lifted = file.lifts.lifted(pick, hooks[place]);
                if (lifted == wanted(pick, place)) continue;
                differs({pick, hooks[place], lifted, use, {}, pick < first_pick()});
            }
        }
    }
};

std::vector<std::size_t> hooks_of(const LoomProfile& profile, HookUse use) {
    const std::vector<HookUse> uses = hook_uses(profile);
    std::vector<std::size_t> hooks;
    for (std::size_t hook = 0; hook < uses.size(); ++hook) {
        if (uses[hook] == use) hooks.push_back(hook);
    }
    return hooks;
}

/// Selvedge hooks as the profile counts them: through its ranges.
std::vector<std::size_t> selvedge_hooks(const LoomProfile& profile) {
    std::vector<std::size_t> hooks;
    for (const HookRange& range : profile.selvedge) {
        for (std::size_t hook = range.first; hook <= range.last && hook < profile.total_hooks; ++hook)
            hooks.push_back(hook);
    }
    return hooks;
}

Status check_fit(const Reading& reading) {
    const ControllerFile& file = reading.file;
    const LoomProfile& profile = reading.profile;
    if (file.lifts.hooks() != profile.total_hooks) {
        return bad_input("the file has " + counted(file.lifts.hooks(), "hook") +
                         ", but the loom of the profile " + std::to_string(profile.total_hooks));
    }
    const std::size_t most = most_ends(profile);
    if (reading.ends == 0 || reading.ends > most) {
        return bad_input("the loom of the profile carries 1 to " + counted(most, "end") + ", not " +
                         std::to_string(reading.ends));
    }
    if (file.picks() <= profile.lead_in_picks) {
        return bad_input("the file has " + counted(file.picks(), "pick") +
                         ", but the lead-in of the loom alone has " + std::to_string(profile.lead_in_picks));
    }
    return check_card_size(file.picks() - profile.lead_in_picks, reading.ends);
}

/// The card by the first hook of each end, and what its other hooks and the hooks of no end do otherwise.
Status read_body(Reading& reading) {
    const HookLifts& lifts = reading.file.lifts;
    std::vector<std::vector<std::size_t>> tied(reading.ends);
    std::vector<bool> carries(lifts.hooks());
    for (std::size_t end = 0; end < reading.ends; ++end) {
        tied[end] = hooks_of_end(reading.profile, end, reading.ends);
        for (const std::size_t hook : tied[end]) {
            if (hook >= lifts.hooks())
                return bad_input("the profile ties ends to hooks that the loom does not have");
            carries[hook] = true;
        }
    }
    const std::size_t first = reading.first_pick();
    reading.made.card = CardImage(lifts.picks() - first, reading.ends);
    for (std::size_t pick = first; pick < lifts.picks(); ++pick) {
        for (std::size_t end = 0; end < reading.ends; ++end) {
            const bool up = lifts.lifted(pick, tied[end].front());
            if (!up) reading.made.card.set(pick - first, end, true);
            for (const std::size_t hook : tied[end]) {
                const bool lifted = lifts.lifted(pick, hook);
                if (lifted != up) reading.differs({pick, hook, lifted, HookUse::body, end, false});
            }
        }
    }
    std::vector<std::size_t> idle = hooks_of(reading.profile, HookUse::body);
    std::erase_if(idle, [&](std::size_t hook) { return carries[hook]; });
    reading.hold(idle, HookUse::body, first, [](std::size_t, std::size_t) { return false; });
    return {};
}

/// No pick of the lead-in takes weft: nothing lifts there but what always does, which is held to elsewhere.
void read_lead_in(Reading& reading) {
    const std::vector<HookUse> uses = hook_uses(reading.profile);
    for (std::size_t pick = 0; pick < reading.first_pick(); ++pick) {
        for (std::size_t hook = 0; hook < uses.size(); ++hook) {
            const bool elsewhere = uses[hook] == HookUse::cast_out || uses[hook] == HookUse::constant_on;
            if (!elsewhere && reading.file.lifts.lifted(pick, hook))
                reading.differs({pick, hook, true, uses[hook], {}, true});
        }
    }
}

void read_fixed_hooks(Reading& reading) {
    const auto always = [](bool lifted) { return [lifted](std::size_t, std::size_t) { return lifted; }; };
    const LoomProfile& profile = reading.profile;
    reading.hold(hooks_of(profile, HookUse::cast_out), HookUse::cast_out, 0, always(false));
    reading.hold(hooks_of(profile, HookUse::constant_on), HookUse::constant_on, 0, always(true));
    const std::size_t first = reading.first_pick();
    reading.hold(selvedge_hooks(profile), HookUse::selvedge, first, [&](std::size_t pick, std::size_t place) {
        return selvedge_lifted(profile, place, pick - first);
    });
}

/// Regulator hooks stop the take-up while they are lifted; the first one that the profile lists decides.
void read_take_up(Reading& reading) {
    const HookLifts& lifts = reading.file.lifts;
    std::vector<std::size_t> hooks = reading.profile.regulator_hooks;
    std::erase_if(hooks, [&](std::size_t hook) { return hook >= lifts.hooks(); });
    if (hooks.empty()) return;
    for (std::size_t pick = reading.first_pick(); pick < lifts.picks(); ++pick)
        reading.made.take_up.push_back(!lifts.lifted(pick, hooks.front()));
    reading.hold(hooks, HookUse::regulator, reading.first_pick(),
                 [&](std::size_t pick, std::size_t) { return lifts.lifted(pick, hooks.front()); });
}

/// Where a pick stands in the file, for a message.
std::string place_of(const ControllerFile& file, std::size_t pick) {
    return controller::at_byte(file.offset_of(pick));
}

/// Which places of the encoding are set on a pick, as a number: bit k for place k.
std::uint64_t selected(const Reading& reading, std::size_t pick) {
    const std::vector<std::size_t>& places = reading.profile.feeder_hooks;
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const bool set = feeders_in_hooks(reading.profile)
                             ? reading.file.lifts.lifted(pick, places[k])
                             : (reading.file.function_words[pick] >> places[k] & 1U) != 0;
        if (set) bits |= std::uint64_t{1} << k;
    }
    return bits;
}

/// Whether the places hold the number of one feeder, from 1.
bool takes_numbers(const LoomProfile& profile) {
    return profile.feeder_encoding == FeederEncoding::binary ||
           profile.feeder_encoding == FeederEncoding::binary_hooks;
}

Result<FeederSet> feeders_of(const Reading& reading, std::size_t pick) {
    const std::uint64_t bits = selected(reading, pick);
    const std::size_t feeders = reading.profile.feeders;
    FeederSet set;
    if (takes_numbers(reading.profile)) {
        if (bits > feeders) {
            return bad_input("pick " + person(pick) + " takes feeder " + std::to_string(bits) +
                                 ", but the loom has " + counted(feeders, "feeder"),
                             place_of(reading.file, pick));
        }
        if (bits > 0) set.push_back(static_cast<std::uint32_t>(bits - 1));
        return set;
    }
    for (std::uint32_t k = 0; k < feeders; ++k) {
        if ((bits >> k & 1) != 0) set.push_back(k);
    }
    if (set.size() <= 2) return set;
    return bad_input("pick " + person(pick) + " takes " + counted(set.size(), "feeder") +
                         " at once, and no loom of this program more than 2",
                     place_of(reading.file, pick));
}

Status check_places(const Reading& reading) {
    const LoomProfile& profile = reading.profile;
    const bool in_hooks = feeders_in_hooks(profile);
    if (!in_hooks && reading.file.function_words.empty()) {
        return bad_input(
            "the profile has the feeders in function bits, but no function bytes; the encodings 'hooks' and "
            "'binary-hooks' name the hooks that select them");
    }
    const std::size_t most = in_hooks ? profile.total_hooks : 8 * profile.function_bytes;
    const bool fits =
        profile.feeder_hooks.size() <= 64 &&
        std::ranges::all_of(profile.feeder_hooks, [&](std::size_t place) { return place < most; });
    if (!fits) return bad_input("the places of the profile's feeders are beyond the last");
    return {};
}

/// Counts the picks of which something is to be told, and keeps the first.
class PickCount {
  public:
    void add(std::size_t pick) {
        if (m_count++ == 0) m_first = pick;
    }
    [[nodiscard]] bool any() const { return m_count > 0; }
    [[nodiscard]] std::size_t first() const { return m_first; }
    [[nodiscard]] std::string in_words() const {
        return counted(m_count, "pick") + (m_count == 1 ? ", pick " : ", the first pick ") + person(m_first);
    }

  private:
    std::size_t m_count = 0, m_first = 0;
};

/// The function bits that the profile gives a meaning on a pick: none in the lead-in, which takes no weft.
std::uint64_t known_bits(const Reading& reading, std::size_t pick) {
    const FeederEncoding encoding = reading.profile.feeder_encoding;
    const bool in_bits = encoding == FeederEncoding::one_hot || encoding == FeederEncoding::binary;
    std::uint64_t known = 0;
    if (!in_bits || pick < reading.first_pick()) return known;
    for (const std::size_t place : reading.profile.feeder_hooks) known |= std::uint64_t{1} << place;
    return known;
}

/// Function bits that are set though the profile gives them no meaning.
void check_function_bits(Reading& reading) {
    const std::vector<std::uint64_t>& words = reading.file.function_words;
    PickCount strange;
    for (std::size_t pick = 0; pick < words.size(); ++pick) {
        if ((words[pick] & ~known_bits(reading, pick)) != 0) strange.add(pick);
    }
    if (!strange.any()) return;
    const std::uint64_t first = words[strange.first()] & ~known_bits(reading, strange.first());
    std::string bits;
    for (std::size_t k = 0; k < 64; ++k) {
        if ((first >> k & 1U) != 0) bits += (bits.empty() ? "" : ", ") + std::to_string(k);
    }
    reading.made.warnings.push_back(
        place_of(reading.file, strange.first()) + ": function bits that the profile does not name" +
        (reading.first_pick() > 0 ? ", or any in the lead-in," : "") + " are set on " + strange.in_words() +
        ", there bits " + bits + " counted from 0");
}

Status read_feeders(Reading& reading) {
    if (reading.profile.feeder_encoding == FeederEncoding::none) return {};
    WEAVE_CHECK_OK(check_places(reading));
    PickCount crowded;
    for (std::size_t pick = reading.first_pick(); pick < reading.file.picks(); ++pick) {
        WEAVE_TRY(FeederSet set, feeders_of(reading, pick));
        if (set.size() > reading.profile.feeders_per_pick) crowded.add(pick);
        reading.made.feeders.push_back(std::move(set));
    }
    if (crowded.any()) {
        reading.made.warnings.push_back(
            place_of(reading.file, crowded.first()) + ": two feeders are taken on " + crowded.in_words() +
            ", but this loom inserts " + std::to_string(reading.profile.feeders_per_pick));
    }
    return {};
}

/// Nobody said how many ends there are: ends that are never lifted may be none.
void check_last_ends(Reading& reading) {
    const CardImage& card = reading.made.card;
    std::size_t ends = card.ends();
    const auto never_lifted = [&](std::size_t end) {
        for (std::size_t pick = 0; pick < card.picks(); ++pick) {
            if (!card.weft_over(pick, end)) return false;
        }
        return true;
    };
    while (ends > 0 && never_lifted(ends - 1)) --ends;
    if (ends == card.ends()) return;
    reading.made.warnings.push_back(
        "end" + std::string(card.ends() - ends == 1 ? " " : "s " + person(ends) + " to ") +
        std::to_string(card.ends()) +
        " never lift; a design with fewer ends than the loom carries is read with their "
        "number given (weave import --ends N)");
}

}  // namespace

std::string in_words(const HookDifference& difference) {
    const std::string hook =
        "hook " + person(difference.hook) + " is " + (difference.lifted ? "lifted" : "down");
    const auto why = [&]() -> std::string {
        if (difference.lead_in && difference.lifted && difference.use != HookUse::cast_out)
            return ", but in the lead-in nothing lifts that is not always lifted";
        switch (difference.use) {
            case HookUse::cast_out:
                return ", but is cast out";
            case HookUse::body:
                return difference.end
                           ? ", but end " + person(*difference.end) + " does otherwise on its first hook"
                           : ", but carries no end";
            case HookUse::selvedge:
                return ", against the selvedge weave of the profile";
            case HookUse::constant_on:
                return ", but is to be lifted on every pick";
            case HookUse::regulator:
                return ", but the first hook of the take-up does otherwise";
            case HookUse::feeder:
                break;
        }
        return "";
    };
    return "pick " + person(difference.pick) + ": " + hook + why();
}

Result<ControllerCard> card_of(const ControllerFile& file, const LoomProfile& profile,
                               std::optional<std::size_t> ends) {
    Reading reading{file, profile, ends.value_or(most_ends(profile)), {}, {}};
    WEAVE_CHECK_OK(check_fit(reading));
    read_lead_in(reading);
    read_fixed_hooks(reading);
    WEAVE_CHECK_OK(read_body(reading));
    read_take_up(reading);
    WEAVE_CHECK_OK(read_feeders(reading));
    check_function_bits(reading);
    if (!ends) check_last_ends(reading);
    return std::move(reading.made);
}

}  // namespace weave
