#include <weave/io/wif.hpp>

#include <weave/io/wif_plans.hpp>
#include <weave/io/wif_private.hpp>

#include <algorithm>

namespace weave {

namespace {

using namespace wif;

/// [WIF]: the version, and the marks by which one knows a file of the standard.
Status check_header(const File& file, Warnings& warnings) {
    const Section* section = file.find("wif");
    if (section == nullptr) return bad_input("has no section [WIF], so this is no WIF file", place(1));
    const Entry* version = section->find("version");
    const std::string said = version == nullptr ? "" : normal(plain(version->value));
    if (version == nullptr) {
        warnings.add(section->line, "[WIF] does not say its Version; read as 1.1");
    } else if (said != "1.1" && (said == "1" || said.substr(0, 2) == "1.")) {
        warnings.add(version->line, "the version is " + in_quotes(said) + "; read as 1.1");
    } else if (said != "1.1") {
        return bad_input("the version is " + in_quotes(said) + ", but only 1.1 is known",
                         place(version->line));
    }
    const Entry* date = section->find("date");
    if (date == nullptr) {
        warnings.add(section->line, "[WIF] lacks the Date of the standard");
    } else if (normal(date->value) != "april 20, 1997") {
        warnings.add(date->line,
                     "the Date is " + in_quotes(date->value) + ", not that of the standard, April 20, 1997");
    }
    for (const char* key : {"developers", "source program"}) {
        if (section->find(key) == nullptr) warnings.add(section->line, "[WIF] lacks " + in_quotes(key));
    }
    return {};
}

/// [CONTENTS] against what is there.
Status check_contents(const File& file, Warnings& warnings) {
    const Section* contents = file.find("contents");
    if (contents == nullptr) {
        warnings.add("the file has no [CONTENTS]; its sections are read as they come");
        return {};
    }
    std::map<std::string, bool> listed;
    for (const Entry& entry : contents->entries) {
        if (!entry.assigns)
            return bad_input(in_quotes(entry.key) + " in [CONTENTS] is not a section and true or false",
                             place(entry.line));
        WEAVE_TRY(const bool there, boolean(entry));
        const std::string name = normal(entry.key);
        if (!listed.try_emplace(name, there).second) {
            warnings.add(entry.line, "[CONTENTS] lists " + shown(name) + " again");
            listed[name] = listed[name] || there;
        }
        if (there && file.find(name) == nullptr)
            warnings.add(entry.line, "[CONTENTS] lists " + shown(name) + ", which is not in the file");
    }
    for (const Section& section : file.sections) {
        if (section.name == "wif" || section.name == "contents") continue;
        const auto entry = listed.find(section.name);
        if (entry == listed.end() || !entry->second)
            warnings.add(section.line, shown(section.name) + " is not listed in [CONTENTS]; it is read");
    }
    return {};
}

/// Sections in which every line must be `key=value`; a second header is odd, though readable.
Status check_sections(const File& file, Warnings& warnings) {
    static constexpr std::string_view settings[] = {"wif", "color palette", "weaving", "warp", "weft"};
    for (const Section& section : file.sections) {
        for (const std::size_t line : section.repeated)
            warnings.add(line, shown(section.name) + " comes again, after line " +
                                   std::to_string(section.line) + "; both are read as one");
        if (std::find(std::begin(settings), std::end(settings), section.name) == std::end(settings)) continue;
        std::map<std::string, const Entry*> seen;
        for (const Entry& entry : section.entries) {
            if (!entry.assigns) {
                return bad_input(
                    in_quotes(entry.key) + " in " + shown(section.name) + " is not a name and its value",
                    place(entry.line));
            }
            const auto [known, is_new] = seen.try_emplace(normal(entry.key), &entry);
            if (is_new) continue;
            const std::string again =
                in_quotes(entry.key) + " comes again, after line " + std::to_string(known->second->line);
            if (plain(known->second->value) != plain(entry.value))
                return bad_input(again + ", with another value", place(entry.line));
            warnings.add(entry.line, again);
        }
    }
    return {};
}

/// At most `longest` bytes of UTF-8, cut between two characters.
std::string shortened(std::string text, std::size_t longest, const std::string& what, Warnings& warnings) {
    if (text.size() <= longest) return text;
    warnings.add(what + " is longer than " + std::to_string(longest) + " bytes and is cut");
    while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0) == 0x80) --longest;
    text.resize(longest);
    return text;
}

/// Title from [TEXT]; the author and [NOTES] as notes.
void read_texts(const File& file, Design& design, Warnings& warnings) {
    std::string notes;
    if (const Section* text = file.find("text")) {
        if (const Entry* title = text->find("title"))
            design.title = shortened(utf8(title->value), longest_title, "the title", warnings);
        if (const Entry* author = text->find("author"); author != nullptr && !author->value.empty())
            notes = "Author: " + utf8(author->value) + "\n";
    }
    if (const Section* section = file.find("notes")) {
        for (const Entry& entry : section->entries) {
            if (notes.size() > longest_notes) break;
            notes += utf8(entry.assigns ? entry.value : entry.key) + "\n";
        }
    }
    if (!notes.empty()) notes.pop_back();
    design.notes = shortened(std::move(notes), longest_notes, "[NOTES]", warnings);
}

}  // namespace

bool is_wif(std::string_view text) {
    text = text.substr(0, std::size_t{1} << 16);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.substr(0, 3) == "\xef\xbb\xbf") line.remove_prefix(3);
        if (line.size() < 200 && normal(line) == "[wif]") return true;
    }
    return false;
}

Result<DesignFromWif> read_wif(std::string_view text) {
    Warnings warnings;
    WEAVE_TRY(const File file, split(text));
    WEAVE_CHECK_OK(check_header(file, warnings));
    WEAVE_CHECK_OK(check_contents(file, warnings));
    WEAVE_CHECK_OK(check_sections(file, warnings));
    WEAVE_TRY(const Drive drive, drive_of(file, warnings));
    WEAVE_TRY(const Threads ends, ends_of(file, warnings));
    WEAVE_TRY(const Threads picks, picks_of(file, drive, warnings));
    WEAVE_TRY(CardImage card, drawdown(file, drive, ends, picks, warnings));
    DesignFromWif result;
    Design& design = result.design;
    WEAVE_TRY(Plans plans, read_plans(file, ends, picks, warnings));
    design.warp = std::move(plans.warp);
    design.weft = std::move(plans.weft);
    read_texts(file, design, warnings);
    design.root = "cloth";
    CardLeaf leaf;
    leaf.card = std::make_shared<const CardImage>(std::move(card));
    design.blocks[design.root] = std::make_shared<const Node>(Node{std::move(leaf), {}});
    WEAVE_CHECK_OK(apply_private(text, file, design, warnings));
    WEAVE_CHECK_OK(check(design));
    result.warnings = std::move(warnings).take();
    return result;
}

}  // namespace weave
