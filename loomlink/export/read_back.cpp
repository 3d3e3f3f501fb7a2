#include <loomlink/export/read_back.hpp>

#include <weave/design/evaluate.hpp>
#include <weave/io/wif.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

Error differs(const std::string& what) {
    return system_fault(what + " does not read back as it was written; nothing is handed out");
}

std::string person(std::size_t index) {
    return std::to_string(index + 1);
}

Status check_lifts(const LiftTable& read, const LiftTable& meant) {
    if (read.picks() != meant.picks() || read.hooks() != meant.hooks())
        return differs("the size of the file (" + std::to_string(read.picks()) + " picks of " +
                       std::to_string(read.hooks()) + " hooks)");
    if (read == meant) return {};
    for (std::size_t pick = 0; pick < meant.picks(); ++pick) {
        for (std::size_t hook = 0; hook < meant.hooks(); ++hook) {
            if (read.lifted(pick, hook) != meant.lifted(pick, hook))
                return differs("hook " + person(hook) + " in record " + person(pick));
        }
    }
    return differs("a lift");
}

Status check_feeders(const std::vector<std::vector<std::size_t>>& read, const HookPlan& plan,
                     const LoomProfile& profile) {
    if (read.size() != plan.feeders.size() - plan.lead_in) return differs("the number of picks with feeders");
    for (std::size_t k = 0; k < read.size(); ++k) {
        auto meant = plan.feeders[plan.lead_in + k];
        std::sort(meant.begin(), meant.end());
        if (profile.feeder_encoding == FeederEncoding::none) meant.clear();
        if (read[k] != meant) return differs("the feeder of pick " + person(k));
    }
    return {};
}

/// The fields of one CSV line (RFC 4180) from `at` on, which moves behind it. Lines end in CRLF.
Result<std::vector<std::string>> take_line(std::string_view csv, std::size_t& at) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (; at < csv.size(); ++at) {
        const char c = csv[at];
        if (quoted) {
            if (c != '"') {
                fields.back() += c;
            } else if (csv.substr(at + 1, 1) == "\"") {
                fields.back() += csv[++at];
            } else {
                quoted = false;
            }
        } else if (c == '"' && fields.back().empty()) {
            quoted = true;
        } else if (c == ',') {
            fields.emplace_back();
        } else if (csv.substr(at, 2) == "\r\n") {
            at += 2;
            return fields;
        } else {
            fields.back() += c;
        }
    }
    return differs("the end of the pick table");
}

/// Feeders as numbers from 1, ` + ` between two.
template <class Number>
std::string joined(const std::vector<std::uint32_t>& feeders, Number number) {
    std::string text;
    for (const std::uint32_t feeder : feeders) {
        if (!text.empty()) text += " + ";
        text += std::to_string(number(feeder) + 1);
    }
    return text;
}

Status check_line(const std::vector<std::string>& fields, const Pick& pick, std::size_t number,
                  const FeederMap& feeders) {
    const char* const way = pick.feeders.empty()                         ? ""
                            : pick.direction == Direction::left_to_right ? "left to right"
                                                                         : "right to left";
    const bool same = fields.size() == 9 && fields[0] == person(number) && fields[1] == person(pick.row) &&
                      fields[2] == joined(pick.feeders, [](std::uint32_t f) { return std::size_t{f}; }) &&
                      fields[4] == way && fields[5] == (pick.take_up ? "yes" : "no") &&
                      fields[8] == joined(pick.feeders, [&](std::uint32_t f) { return feeders.at(f); });
    return same ? Status{} : differs("line " + person(number + 1) + " of the pick table");
}

}  // namespace

Status check_decoded(const DecodedFile& read, const InFileNames& names, const HookPlan& plan,
                     const CardImage& card, const LoomProfile& profile) {
    if (read.names.name != names.name) return differs("the name");
    if (read.names.comment != names.comment) return differs("the comment");
    WEAVE_CHECK_OK(check_lifts(read.lifts, plan.lifts));
    if (read.card != card) return differs("the card image");
    WEAVE_CHECK_OK(check_feeders(read.feeders, plan, profile));
    if (read.oddities.empty()) return {};
    return system_fault("the file reads back with what it should not have: " + read.oddities.front() +
                        "; nothing is handed out");
}

Status check_controller_file(std::string_view bytes, const InFileNames& names, const HookPlan& plan,
                             const CardImage& card, const LoomProfile& profile) {
    const Result<DecodedFile> read = decode_controller_file(bytes, profile, card.ends());
    if (read) return check_decoded(*read, names, plan, card, profile);
    return system_fault("the file does not read back: " + read.error().text() + "; nothing is handed out");
}

Status check_pick_table(std::string_view csv, const std::vector<Pick>& picks, const FeederMap& feeders) {
    std::size_t at = 0;
    WEAVE_TRY(const auto heading, take_line(csv, at));
    const std::vector<std::string> meant{"pick",    "row",  "feeder", "feeder name", "direction",
                                         "take-up", "yarn", "colour", "loom feeder"};
    if (heading != meant) return differs("the heading of the pick table");
    for (std::size_t k = 0; k < picks.size(); ++k) {
        WEAVE_TRY(const auto fields, take_line(csv, at));
        WEAVE_CHECK_OK(check_line(fields, picks[k], k, feeders));
    }
    return at == csv.size() ? Status{} : differs("the end of the pick table");
}

Status check_wif(std::string_view text, const CardImage& card, const std::vector<Pick>& picks) {
    const Result<DesignFromWif> read = read_wif(text);
    if (!read) return differs("the WIF file (" + read.error().text() + ")");
    const Result<Evaluation> cloth = Evaluator().evaluate(read->design);
    if (!cloth || cloth->block->card_image() != card) return differs("the card image of the WIF file");
    const std::vector<Pick> found = pick_table(read->design, *cloth->block);
    const bool same =
        std::equal(found.begin(), found.end(), picks.begin(), picks.end(), [](const Pick& a, const Pick& b) {
            return a.feeders == b.feeders && a.direction == b.direction && a.take_up == b.take_up;
        });
    return same ? Status{} : differs("the pick order of the WIF file");
}

}  // namespace weave::loomlink
