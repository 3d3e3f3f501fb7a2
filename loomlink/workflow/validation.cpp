#include <loomlink/workflow/validation.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <array>

namespace weave::loomlink {

namespace {

constexpr std::array severity_words{"off", "info", "warning", "error"};
constexpr std::size_t most_validations = 10000;

Json number_or_null(const std::optional<std::size_t>& number) {
    return number ? Json(*number + 1) : Json(nullptr);
}

Validation from_record(const EventRecord& record) {
    const Json& data = record.statement.data;
    Validation found;
    found.loom = data.at("loom");
    found.profile_version = data.at("profile_version");
    found.profile_sha256 = data.at("profile_sha256");
    found.errors = data.at("errors");
    found.warnings = data.at("warnings");
    found.not_evaluated = data.at("not_evaluated");
    for (const auto& [rule, count] : data.at("error_rules").items()) found.error_rules[rule] = count;
    found.event = record.seq;
    found.at = record.statement.at;
    return found;
}

Result<LoomProfile> read_stored(const Reader& reader, const Hash& object) {
    WEAVE_TRY(const auto text, reader.object(object));
    if (!text) return system_fault("the store is damaged: a loom profile is missing");
    return read_profile(*text);
}

}  // namespace

Result<ProfileInForce> profile_in_force(const Reader& reader, Id loom) {
    WEAVE_TRY(const auto versions, reader.profiles(loom));
    if (versions.empty()) return system_fault("the store is damaged: a loom has no profile");
    WEAVE_TRY(LoomProfile profile, read_stored(reader, versions.back().object));
    return ProfileInForce{versions.back().version, std::move(profile)};
}

FeederMap straight_map(const weave::Design& design) {
    FeederMap map;
    for (std::size_t k = 0; k < design.weft.feeders.size(); ++k) map[static_cast<std::uint32_t>(k)] = k;
    return map;
}

CheckReport check_with_file(const RevisionCloth& cloth, const LoomProfile& profile, const FeederMap& feeders,
                            const std::string& stem) {
    return check_for_loom(cloth.design, cloth.evaluation, profile, {},
                          read_back(cloth.design, cloth.evaluation, profile, feeders, {stem, stem}));
}

Validation validate(const RevisionCloth& cloth, const std::string& loom, const ProfileInForce& profile,
                    const FeederMap& feeders, const std::string& stem) {
    const CheckReport report = check_with_file(cloth, profile.profile, feeders, stem);
    Validation found;
    found.loom = loom;
    found.profile_version = profile.version;
    found.profile_sha256 = profile.profile.sha256;
    found.errors = report.count(Severity::error);
    found.warnings = report.count(Severity::warning);
    found.not_evaluated = report.not_evaluated.size();
    for (const Finding& finding : report.findings)
        if (finding.severity == Severity::error) ++found.error_rules[finding.rule];
    return found;
}

Json to_json(const CheckReport& report) {
    Json findings = Json::array(), missing = Json::array();
    for (const Finding& finding : report.findings)
        findings.push_back({{"rule", finding.rule},
                            {"severity", severity_words[static_cast<std::size_t>(finding.severity)]},
                            {"pick", number_or_null(finding.pick)},
                            {"end", number_or_null(finding.end)},
                            {"message", finding.message}});
    for (const NotEvaluated& rule : report.not_evaluated)
        missing.push_back({{"rule", rule.rule}, {"reason", rule.reason}});
    return {{"errors", report.count(Severity::error)},
            {"warnings", report.count(Severity::warning)},
            {"findings", std::move(findings)},
            {"not_evaluated", std::move(missing)},
            {"passed_rules", report.passed}};
}

Json to_data(const Validation& validation, const Revision& revision) {
    Json rules = Json::object();
    for (const auto& [rule, count] : validation.error_rules) rules[rule] = count;
    return {{"revision", revision.number},
            {"sha256", hash_hex(revision.hash)},
            {"design_sha256", hash_hex(revision.design_sha256)},
            {"libweave", WEAVE_VERSION},
            {"loom", validation.loom},
            {"profile_version", validation.profile_version},
            {"profile_sha256", validation.profile_sha256},
            {"errors", validation.errors},
            {"warnings", validation.warnings},
            {"not_evaluated", validation.not_evaluated},
            {"error_rules", std::move(rules)}};
}

Result<std::vector<Validation>> validations_of(const Reader& reader, const Design& design,
                                               const Revision& revision) {
    WEAVE_TRY(const auto records, reader.events({.from = revision.event,
                                                 .most = most_validations,
                                                 .kind = "revision.validated",
                                                 .subject = design.name}));
    std::map<std::string, Validation> newest;
    for (const auto& [seq, bytes] : records) {
        WEAVE_TRY(const EventRecord record, parse_record(bytes));
        if (record.statement.data.at("revision") != revision.number) continue;
        Validation found = from_record(record);
        newest[found.loom] = std::move(found);
    }
    std::vector<Validation> list;
    for (auto& [loom, validation] : newest) list.push_back(std::move(validation));
    return list;
}

Result<std::vector<WaivedFinding>> waivers_with_looms(const Reader& reader, Id revision) {
    WEAVE_TRY(auto waivers, reader.waivers(revision));
    std::vector<WaivedFinding> list;
    for (Waiver& waiver : waivers) {
        WEAVE_TRY(const EventRecord record, reader.record(waiver.event));
        list.push_back({std::move(waiver), record.statement.data.at("loom")});
    }
    return list;
}

std::vector<std::string> open_errors(const Validation& validation, const std::vector<WaivedFinding>& waived) {
    std::vector<std::string> open;
    for (const auto& [rule, count] : validation.error_rules) {
        const bool is_waived = std::any_of(waived.begin(), waived.end(), [&, &rule = rule](const WaivedFinding& one) {
            return one.waiver.rule == rule && one.loom == validation.loom;
        });
        if (!is_waived)
            open.push_back(counted(count, "error") + " of " + rule + " for the loom " + validation.loom +
                           ": mend or waive");
    }
    return open;
}

}  // namespace weave::loomlink
