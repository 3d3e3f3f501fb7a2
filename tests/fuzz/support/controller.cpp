#include "controller.hpp"

#include "../../support/controller_bytes.hpp"
#include "must.hpp"

#include <weave/io/controller_file.hpp>

#include <optional>
#include <string>

namespace weave::fuzz {

namespace {

/// Number 0 is the plain one; bits of others turn polarity, bit order, pick order, permutation and lead-in.
LoomProfile loom(OutputFormat format, unsigned number) {
    LoomProfile profile;
    profile.name = "fuzzed";
    profile.output = format;
    profile.areas = {{"fn", 8}, {"sel", 8}, {"body", 16}};
    profile.total_hooks = 32;
    profile.body = {{16, 31}};
    profile.selvedge = {{8, 11}};
    profile.selvedge_weave = {"01", "10"};
    profile.constant_on = {{12, 12}};
    profile.regulator_hooks = {13, 14};
    profile.feeders = 3;
    profile.feeders_per_pick = 2;
    profile.function_bytes = format == OutputFormat::ep ? 4 : 0;
    profile.feeder_encoding = format == OutputFormat::ep ? FeederEncoding::one_hot : FeederEncoding::hooks;
    profile.feeder_hooks = {0, 1, 2};
    profile.lifted_is_one = (number & 1) == 0;
    profile.least_bit_first = (number & 2) == 0;
    profile.pick_1_at_bottom = (number & 4) == 0;
    for (std::size_t hook = 0; hook < 32 && (number & 8) != 0; ++hook)
        profile.hook_permutation.push_back(hook * 5 % 32);
    profile.lead_in_picks = (number & 16) == 0 ? 0 : 1;
    profile.hook_rule = (number & 32) == 0 ? HookRule::straight : HookRule::point;
    profile.end_1_at_left = (number & 32) == 0;
    return profile;
}

/// Too many picks are read, but not encoded again: runs stay quick.
constexpr std::size_t most_picks = 256;

std::string encoded(const ControllerFile& file, const LoomProfile& profile) {
    testing::Shed shed(file.picks(), std::string(file.lifts.hooks(), '.'));
    for (std::size_t pick = 0; pick < shed.size(); ++pick)
        for (std::size_t hook = 0; hook < shed[pick].size(); ++hook)
            if (file.lifts.lifted(pick, hook)) shed[pick][hook] = 'X';
    if (profile.output == OutputFormat::jc5)
        return testing::jc5_bytes(file.name, file.comment, shed, profile);
    if (profile.output == OutputFormat::ep)
        return testing::ep_bytes(file.name, shed, file.function_words, profile);
    return testing::raw_bytes(shed, profile, file.function_words);
}

bool comes_again(const ControllerFile& file) {
    return file.warnings.empty() && file.picks() <= most_picks;
}

void check_card(const ControllerFile& file, const LoomProfile& profile, std::optional<std::size_t> ends) {
    const auto read = card_of(file, profile, ends);
    if (!read) {
        must(!read.error().message.empty(), "a refusal says why");
        return;
    }
    const std::size_t picks = file.picks() - profile.lead_in_picks;
    must(read->card.picks() == picks, "the card has the picks of the file without the lead-in");
    must(read->card.ends() == ends.value_or(most_ends(profile)), "the card has the ends that were asked for");
    must(read->feeders.size() == picks && read->take_up.size() == picks,
         "every pick has its feeders and take-up");
    must(read->differences.size() <= read->difference_count, "what is listed is counted");
    for (const HookDifference& difference : read->differences) {
        must(difference.pick < file.picks() && difference.hook < file.lifts.hooks(),
             "a difference lies in the file");
        must(file.lifts.lifted(difference.pick, difference.hook) == difference.lifted,
             "a difference is as in the file");
        must(!in_words(difference).empty(), "a difference can be told");
    }
}

}  // namespace

void try_controller(std::string_view bytes, OutputFormat format) {
    static_cast<void>(recognise_controller_file(bytes, ""));
    for (unsigned number = 0; number < 64; number = number == 0 ? 1 : number * 2 + 1) {
        const LoomProfile profile = loom(format, number);
        const auto file = read_controller_file(bytes, profile);
        if (!file) {
            must(!file.error().message.empty() && !file.error().where.empty(),
                 "a refusal says where and why");
            return;  // no setting of these looms changes what can be read
        }
        must(file->picks() > 0 && file->lifts.hooks() == 32, "a file has picks, and the hooks of the loom");
        must(file->records_at + file->picks() * file->record_bytes <= bytes.size(),
             "all records lie in the file");
        if (comes_again(*file))
            must(encoded(*file, profile) == bytes, "what is as observed comes again");
        check_card(*file, profile, {});
        check_card(*file, profile, 5);
    }
    static_cast<void>(design_from_controller_file(bytes, loom(format, 0)));
}

}  // namespace weave::fuzz
