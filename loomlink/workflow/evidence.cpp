#include <loomlink/workflow/evidence.hpp>

#include <weave/keys/codes.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/signed_document.hpp>

#include <algorithm>
#include <iomanip>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/names.hpp>
#include <set>
#include <sstream>

namespace weave::loomlink {

namespace {

constexpr const char* signer_purpose = "evidence";

/// What the column `parameters` of the store holds: all that was signed beside its other columns.
Json kept_parameters(const wire::SimulationStatement& statement) {
    const Json body = statement_body(statement);
    return {{"parameters", statement.parameters},
            {"regions", body.at("regions")},
            {"order_kept", statement.order_kept},
            {"plan", body.at("plan")},
            {"result_sha256", body.at("result_sha256")}};
}

Result<std::string> signer_name(const Reader& reader, const PersonKey& key) {
    WEAVE_TRY(const EventRecord record, reader.record(key.created));
    return record.statement.subject.value_or(key.id);
}

Result<std::vector<PersonKey>> signer_keys(const Reader& reader) {
    WEAVE_TRY(auto keys, reader.keys({}));
    std::erase_if(keys, [](const PersonKey& key) { return key.purpose != signer_purpose; });
    return keys;
}

/// The keys of a machine that count.
Result<std::vector<PersonKey>> keys_of_signer(const Reader& reader, const std::string& name) {
    WEAVE_TRY(const auto keys, signer_keys(reader));
    std::vector<PersonKey> own;
    for (const PersonKey& key : keys) {
        WEAVE_TRY(const std::string named, signer_name(reader, key));
        if (named == name && !key.revoked) own.push_back(key);
    }
    return own;
}

std::string what_changed(const Revision& revision, const Revision& other) {
    const std::string since = " changed since revision " + std::to_string(other.number);
    if (other.design_sha256 == revision.design_sha256) return "the scene" + since;
    if (other.scene_sha256 == revision.scene_sha256) return "the design" + since;
    return "design and scene" + since;
}

Result<KnownSimulation> known_simulation(const Reader& reader, const Evidence& evidence) {
    KnownSimulation known;
    known.evidence = evidence;
    WEAVE_TRY(const Json kept, parse_json(evidence.parameters));
    known.order_kept = kept.at("order_kept").get<bool>();
    known.result_sha256 = kept.at("result_sha256").get<std::string>();
    for (const Json& region : kept.at("regions"))
        known.regions.push_back(
            {region.at("first_pick"), region.at("picks"), region.at("first_end"), region.at("ends")});
    WEAVE_TRY(const auto key, reader.key(evidence.signer));
    if (!key) return system_fault("the store is damaged: a signer is missing");
    WEAVE_TRY(known.signer, signer_name(reader, *key));
    WEAVE_TRY(const EventRecord record, reader.record(evidence.event));
    known.at = record.statement.at;
    if (key->revoked)
        known.stale = "its signer was revoked";
    else if (!evidence.converged)
        known.stale = "the yarns did not come to rest";
    else if (!known.order_kept)
        known.stale = "the yarns do not lie as the card says";
    return known;
}

}  // namespace

Result<std::vector<KnownSimulation>> simulations_of(const Reader& reader, const Revision& revision) {
    std::vector<KnownSimulation> list;
    std::set<Id> seen;
    const auto add = [&](const Revision& of, const std::string& stale) -> Status {
        WEAVE_TRY(const auto found, reader.evidence(of.design_sha256, of.scene_sha256));
        for (const Evidence& evidence : found) {
            if (!seen.insert(evidence.id).second) continue;
            WEAVE_TRY(KnownSimulation known, known_simulation(reader, evidence));
            if (!stale.empty()) known.stale = stale;
            list.push_back(std::move(known));
        }
        return {};
    };
    WEAVE_CHECK_OK(add(revision, {}));
    WEAVE_TRY(const auto others, reader.revisions(revision.design));
    for (auto other = others.rbegin(); other != others.rend(); ++other)
        if (other->number < revision.number) WEAVE_CHECK_OK(add(*other, what_changed(revision, *other)));
    return list;
}

std::vector<std::string> missing_simulation(const std::vector<KnownSimulation>& known,
                                            const Revision& revision, const SitePolicy& policy) {
    if (!policy.simulation_required) return {};
    const auto picks = static_cast<std::size_t>(revision.picks);
    const auto ends = static_cast<std::size_t>(revision.ends);
    std::vector<wire::SimulatedRegion> regions;
    for (const KnownSimulation& one : known) {
        if (!one.stale.empty() || rank_of_fidelity(one.evidence.fidelity) < rank_of_fidelity(policy.fidelity))
            continue;
        if (one.regions.empty()) regions.push_back({0, picks, 0, ends});
        regions.insert(regions.end(), one.regions.begin(), one.regions.end());
    }
    if (regions.empty())
        return {"a simulation of this very design and scene, at " + policy.fidelity +
                " or finer, at rest and with its yarns in order"};
    const double share = covered_share(regions, picks, ends);
    if (share >= policy.coverage) return {};
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << "simulations of " << 100 * policy.coverage
         << " % of the crossings; " << 100 * share << " % are covered";
    return {text.str()};
}

Result<Json> EvidenceDesk::invite_signer(const Caller& caller, const Ask& ask, const std::string& name) {
    const std::string code = make_code();
    WEAVE_TRY(const std::string hashed, code_hash(code));
    const std::string expires = utc_text(m_desk->now() + m_desk->settings().invitation);
    Deed deed{"signer.invited", name, {}, {{"code_sha256", hashed}, {"expires", expires}}};
    deed.told_once = true;
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader&, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
            return check_name(name, "name", false);
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_CHECK_OK(
                writer.add_invitation({*parse_hash(hashed), "signer", name, "", expires, step.event, {}}));
            return Json{{"code", code}, {"expires", expires}};
        });
}

Result<Json> EvidenceDesk::enrol(const std::string& code, const std::string& public_key,
                                 const std::string& address) {
    WEAVE_CHECK_OK(m_desk->count_try({}, address));
    WEAVE_TRY(const PublicKey key, parse_public_key(public_key));
    WEAVE_TRY(const std::string hashed, code_hash(code));
    const Hash hash = *parse_hash(hashed);
    Deed deed{"signer.enrolled",
              {},
              {},
              {{"key", key_id(key)}, {"public_key", to_hex(key)}, {"code_sha256", hashed}}};
    auto answer = m_desk->store().write([&](Writer& writer) -> Result<Json> {
        WEAVE_TRY(const auto found, writer.invitation(hash));
        if (!found || found->purpose != "signer" || found->used || found->expires <= m_desk->now_text())
            return deny(Denial::rights, "this code is not, or no longer, good");
        WEAVE_TRY(const auto same, writer.key(key_id(key)));
        if (same) return deny(Denial::conflict, "this key is known already; make a new one");
        deed.subject = *found->name;
        WEAVE_TRY(const Seq event, writer.append(m_desk->statement_of(*found->name, make_token(), deed)));
        PersonKey row;
        row.id = key_id(key);
        row.purpose = signer_purpose;
        row.public_key = key;
        row.created = event;
        WEAVE_CHECK_OK(writer.add_key(row));
        WEAVE_CHECK_OK(writer.use_invitation(hash, event));
        return Json{{"name", *found->name}, {"key", row.id}, {"site", m_desk->site()}};
    });
    if (!answer) return m_desk->refuse_stranger("nobody", deed, answer.error());
    return answer;
}

Result<Json> EvidenceDesk::revoke_signer(const Caller& caller, const Ask& ask, const std::string& name) {
    const Deed deed{"signer.revoked", name, {}, Json::object()};
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
            WEAVE_TRY(const auto keys, keys_of_signer(reader, name));
            return keys.empty() ? Status(deny(Denial::absent, "there is no such signer")) : Status();
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(const auto keys, keys_of_signer(writer, name));
            for (const PersonKey& key : keys) WEAVE_CHECK_OK(writer.revoke_key(key.id, step.event));
            return Json::object();
        });
}

Result<Json> EvidenceDesk::signers(const Caller& caller) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_CHECK_OK(need_role(caller, PersonRole::administrator));
        WEAVE_TRY(const auto keys, signer_keys(reader));
        Json list = Json::array();
        for (const PersonKey& key : keys) {
            WEAVE_TRY(const std::string name, signer_name(reader, key));
            list.push_back({{"name", name}, {"key", key.id}, {"revoked", key.revoked.has_value()}});
        }
        return Json{{"signers", std::move(list)}};
    });
}

namespace {

/// Whether this signature authorises evidence about this revision.
Result<std::string> check_signer(const Reader& reader, const std::string& site, const Revision& revision,
                                 const wire::SimulationStatement& statement, const Json& body,
                                 const Signature& signature) {
    WEAVE_TRY(const auto key, reader.key(signature.key));
    if (!key || key->purpose != signer_purpose || key->revoked)
        return deny(Denial::rights, "the signer is not enrolled, or was revoked");
    if (!verify_body(key->public_key, Purpose::evidence, body, signature))
        return deny(Denial::rights, "the signature does not fit the statement");
    if (statement.site != site) return deny(Denial::conflict, "the statement is for another site");
    if (statement.design_sha256 != revision.design_sha256 || statement.scene_sha256 != revision.scene_sha256)
        return deny(Denial::conflict, "the evidence is about another design or scene than this revision's");
    if (statement.picks != static_cast<std::size_t>(revision.picks) ||
        statement.ends != static_cast<std::size_t>(revision.ends))
        return deny(Denial::conflict, "the evidence is about a cloth of another size");
    return signer_name(reader, *key);
}

}  // namespace

Evidence evidence_row(const wire::SimulationStatement& statement, const std::string& signer, Seq event) {
    Evidence row;
    row.design_sha256 = statement.design_sha256;
    row.scene_sha256 = statement.scene_sha256;
    row.coverage =
        statement.regions.empty() ? 1 : covered_share(statement.regions, statement.picks, statement.ends);
    row.fidelity = statement.fidelity;
    row.parameters = canonical_json(kept_parameters(statement));
    row.solver = statement.solver;
    row.residual = statement.residual;
    row.converged = statement.converged;
    row.report = statement.report_sha256;
    row.signer = signer;
    row.event = event;
    return row;
}

Result<Json> EvidenceDesk::add(const std::string& design, std::int64_t number, const std::string& request,
                               const Json& body, const Signature& signature, std::string_view report) {
    WEAVE_TRY(const wire::SimulationStatement statement, wire::read_simulation(body));
    if (report.size() > wire::most_report) return bad_input("has more than 4 MiB", "report");
    if (!report.empty() && sha256(report) != statement.report_sha256)
        return bad_input("is not the report that was signed", "report");
    Deed deed{
        "evidence.added",
        design,
        {},
        {{"revision", number}, {"statement", body}, {"key", signature.key}, {"signature", signature.value}}};
    auto answer = m_desk->store().write([&](Writer& writer) -> Result<Json> {
        WEAVE_TRY(const auto found, writer.design(design));
        if (!found) return deny(Denial::absent, "there is no such design");
        WEAVE_TRY(const auto revision, writer.revision(found->id, number));
        if (!revision) return deny(Denial::absent, "the design has no such revision");
        WEAVE_TRY(const std::string signer,
                  check_signer(writer, m_desk->site(), *revision, statement, body, signature));
        WEAVE_TRY(const auto known, writer.evidence(statement.design_sha256, statement.scene_sha256));
        for (const Evidence& one : known) {
            WEAVE_TRY(const EventRecord record, writer.record(one.event));
            if (record.statement.data.at("signature") == signature.value)
                return Json{{"evidence", one.id}};  // handed in before
        }
        if (!report.empty()) WEAVE_CHECK_OK(writer.put_object(report));
        WEAVE_TRY(const Seq event, writer.append(m_desk->statement_of(signer, request, deed)));
        WEAVE_TRY(const Id id, writer.add_evidence(evidence_row(statement, signature.key, event)));
        return Json{{"evidence", id}};
    });
    if (!answer) return m_desk->refuse_stranger("nobody", deed, answer.error());
    return answer;
}

}  // namespace weave::loomlink
