#include <weave/core/text.hpp>
#include <weave/io/controller_file.hpp>

#include <algorithm>
#include <map>
#include <memory>

namespace weave {

namespace {

/// At most `longest` bytes, cut between two characters.
std::string shortened(std::string text, std::size_t longest, const std::string& what,
                      std::vector<std::string>& warnings) {
    if (text.size() <= longest) return text;
    warnings.push_back(what + " is longer than " + std::to_string(longest) + " bytes and is cut");
    while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0) == 0x80) --longest;
    text.resize(longest);
    return text;
}

/// Blanks that fill a field are no part of what it says.
std::string without_filling(const std::string& text) {
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// The part of a list that repeats.
template <class Item>
std::vector<Item> repeating(std::vector<Item> list) {
    std::map<Item, std::uint32_t> numbers;
    std::vector<std::uint32_t> numbered;
    for (const Item& item : list)
        numbered.push_back(numbers.emplace(item, static_cast<std::uint32_t>(numbers.size())).first->second);
    list.resize(shortest_repeat(numbered).size());
    return list;
}

void set_weft(const LoomProfile& profile, ControllerCard& read, WeftPlan& weft) {
    if (!read.feeders.empty()) {
        weft.feeders.clear();
        const std::string word = profile.insertion == Insertion::shuttle ? "shuttle " : "feeder ";
        for (std::size_t k = 0; k < profile.feeders; ++k)
            weft.feeders.push_back({word + std::to_string(k + 1), 0});
        weft.feeder_order = repeating(std::move(read.feeders));
    }
    if (!read.take_up.empty()) weft.take_up = repeating(std::move(read.take_up));
}

void tell(const ControllerCard& read, const LoomProfile& profile, std::vector<std::string>& warnings) {
    warnings.insert(warnings.end(), read.warnings.begin(), read.warnings.end());
    for (const HookDifference& difference : read.differences) warnings.push_back(in_words(difference));
    if (const std::size_t more = read.difference_count - read.differences.size(); more > 0)
        warnings.push_back("and " + std::to_string(more) + " more hooks that do otherwise on some pick");
    if (profile.lead_in_picks > 0) {
        warnings.push_back("the first " + counted(profile.lead_in_picks, "pick") +
                           " of the file, the lead-in of the loom, are no part of the card");
    }
}

}  // namespace

Result<DesignFromController> design_from_controller_file(std::string_view bytes, const LoomProfile& profile,
                                                         std::optional<std::size_t> ends) {
    WEAVE_TRY(ControllerFile file, read_controller_file(bytes, profile));
    WEAVE_TRY(ControllerCard read, card_of(file, profile, ends));
    DesignFromController result;
    result.warnings = std::move(file.warnings);
    tell(read, profile, result.warnings);
    Design& design = result.design;
    design.title = shortened(without_filling(file.name), longest_title, "the name", result.warnings);
    design.notes = shortened(without_filling(file.comment), longest_notes, "the comment", result.warnings);
    set_weft(profile, read, design.weft);
    design.root = "card";
    const CardLeaf leaf{std::make_shared<const CardImage>(std::move(read.card)), {1}, {1}};
    design.blocks[design.root] = std::make_shared<const Node>(Node{leaf, {}});
    WEAVE_CHECK_OK(check(design));
    return result;
}

}  // namespace weave
