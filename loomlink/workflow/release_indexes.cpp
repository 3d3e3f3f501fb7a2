#include <weave/core/sha256.hpp>

#include <algorithm>
#include <loomlink/workflow/policy.hpp>
#include <loomlink/workflow/releases.hpp>

namespace weave::loomlink {

namespace {

std::optional<ReleaseState> index_state(ReleaseStage state) {
    switch (state) {
        case ReleaseStage::released:
            return ReleaseState::released;
        case ReleaseStage::superseded:
            return ReleaseState::superseded;
        case ReleaseStage::withdrawn:
            return ReleaseState::withdrawn;
        case ReleaseStage::prepared:
            break;
    }
    return {};
}

/// Adds a release that was in force at some time, and the records that changed what is listed of it.
Status add_entry(const Reader& reader, const Release& release, ReleaseIndex& index) {
    WEAVE_TRY(const auto steps, reader.release_steps(release.id));
    const bool was_released = std::any_of(steps.begin(), steps.end(), [](const Step<ReleaseStage>& step) {
        return step.state == ReleaseStage::released;
    });
    const auto state = index_state(release.state);
    if (!was_released || !state) return {};
    for (const auto& step : steps) index.epoch = std::max(index.epoch, step.event + 1);
    for (const ReleaseSignature& one : release.signatures) index.epoch = std::max(index.epoch, one.event + 1);
    WEAVE_TRY(const auto revision, reader.revision(release.revision));
    WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, release));
    index.releases.push_back({static_cast<std::uint64_t>(release.number), hash_hex(revision->hash),
                              sha256_hex(manifest.bytes), *state});
    return {};
}

Result<ReleaseIndex> listed(const Reader& reader, const Desk& desk, const Loom& loom) {
    WEAVE_TRY(const auto trust, newest_trust(reader));
    if (!trust) return deny(Denial::conflict, "the site has no trust document yet");
    if (trust->find(desk.keys().stamp.id()) == nullptr)
        return deny(Denial::conflict, "the newest trust document does not list the server's stamp key");
    ReleaseIndex index;
    index.site = desk.site();
    index.loom = loom.name;
    index.trust = trust->version;
    WEAVE_TRY(const auto paper, reader.latest_trust());
    if (!paper) return system_fault("the store is damaged: its newest trust document is gone");
    index.epoch = std::max<std::uint64_t>(loom.event, paper->event) + 1;  // signatures count by it
    WEAVE_TRY(const auto releases, reader.releases(loom.id));
    for (auto release = releases.rbegin(); release != releases.rend(); ++release)
        WEAVE_CHECK_OK(add_entry(reader, *release, index));
    return index;
}

SignedLogHead as_log_head(const SignedTreeHead& head) {
    return {{head.head.site, head.head.size, hash_hex(head.head.root), parse_utc(head.head.at).value()},
            {head.signature.key, head.signature.value}};
}

/// What an answer about a loom's releases is to hold.
struct IndexTerms {
    SignedTreeHead head;
    std::int64_t trust_from = 0;
    std::uint64_t head_from = 0;
};

Result<Json> index_answer(const Reader& reader, const Desk& desk, const Loom& loom, const IndexTerms& terms) {
    WEAVE_TRY(ReleaseIndex index, listed(reader, desk, loom));
    if (index.epoch > terms.head.head.size)
        return deny(Denial::conflict, "the loom's releases changed just now: ask again");
    WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
    index.issued = desk.now();
    index.expires = index.issued + std::chrono::hours(policy.index_valid_hours);
    index.tree_head = as_log_head(terms.head);
    const Json body = index_body(index);
    Json answer{
        {"index", write_signed({body, {sign_body(desk.keys().stamp, Purpose::release_index, body)}})}};
    WEAVE_TRY(const auto papers, reader.trust_documents(terms.trust_from));
    answer["trust"] = Json::array();
    for (const SitePaper& paper : papers) answer["trust"].push_back(paper.text);
    if (terms.head_from == 0) return answer;
    WEAVE_TRY(const auto proof, reader.consistency(terms.head_from, terms.head.head.size));
    answer["consistency"] = Json::array();
    for (const Hash& hash : proof) answer["consistency"].push_back(hash_hex(hash));
    return answer;
}

}  // namespace

Result<SignedTreeHead> current_head(Desk& desk) {
    struct Newest {
        std::optional<SignedTreeHead> head;
        std::uint64_t size = 0;
    };
    WEAVE_TRY(const Newest known, desk.store().read([](const Reader& reader) -> Result<Newest> {
        Newest newest;
        WEAVE_TRY(newest.head, reader.latest_head());
        WEAVE_TRY(newest.size, reader.log_size());
        return newest;
    }));
    const std::string own = desk.keys().log.id();
    if (known.head && known.head->head.size == known.size && known.head->signature.key == own)
        return *known.head;
    return desk.store().write([&](Writer& writer) -> Result<SignedTreeHead> {
        WEAVE_TRY(const std::uint64_t size, writer.log_size());
        WEAVE_TRY(const Hash root, writer.root(size));
        SignedTreeHead head{{desk.site(), size, root, desk.now_text()}, {}};
        const Signature made = desk.keys().log.sign(Purpose::tree_head, head_bytes(head.head));
        head.signature = {made.key, made.value};
        WEAVE_CHECK_OK(writer.add_head(head));
        return head;
    });
}

Result<Json> ReleaseDesk::index(const Caller& caller, const std::string& loom, std::int64_t trust_from,
                                std::uint64_t head_from) {
    return m_desk->look(caller, {"loom.index_pulled", loom}, [&]() -> Result<Json> {
        // Whose loom it is not makes the server sign no head.
        WEAVE_TRY(const Loom found, m_desk->store().read([&](const Reader& reader) {
            return find_loom(reader, caller, loom);
        }));
        WEAVE_TRY(const SignedTreeHead head, current_head(*m_desk));
        return m_desk->store().read([&](const Reader& reader) {
            return index_answer(reader, *m_desk, found, {head, trust_from, head_from});
        });
    });
}

}  // namespace weave::loomlink
