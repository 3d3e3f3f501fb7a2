#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/terminal/check.hpp>

namespace weave::loomlink {

namespace {

Error refused(std::string why, std::string where = "index") {
    return {ErrorCode::refused, std::move(why), std::move(where)};
}

std::string number_of(std::uint64_t number) {
    return std::to_string(number);
}

Status check_subject(const TerminalState& state, const ReleaseIndex& index) {
    if (index.loom != state.loom)
        return refused("lists releases for the loom '" + index.loom + "', not for '" + state.loom + "'");
    if (index.trust > state.trust.version)
        return refused("was stamped under trust document " + number_of(index.trust) +
                       ", which this terminal does not have yet; fetch the trust documents first");
    if (index.trust < state.trust.version)
        return refused("was stamped under trust document " + number_of(index.trust) + ", which version " +
                       number_of(state.trust.version) + " has replaced");
    return {};
}

Status check_time(const TerminalState& state, const ReleaseIndex& index, Instant now) {
    if (now + clock_tolerance < state.last_seen)
        return refused("cannot be judged: the clock of this terminal stands at " + utc_text(now) +
                       ", before " + utc_text(state.last_seen) +
                       ", when it last took an index; set the clock");
    if (index.issued > now + clock_tolerance)
        return refused("is from the future: issued at " + utc_text(index.issued) +
                       ", and the clock here says " + utc_text(now));
    if (now >= index.expires)
        return refused("has run out at " + utc_text(index.expires) +
                       ": somebody may be holding newer ones back, or the server is down");
    return {};
}

/// What the keys that still count have shown so far; no key may go behind another.
Status check_epoch(const TerminalState& state, const std::string& key, const ReleaseIndex& index,
                   const LogHead& head) {
    if (index.epoch > head.size)
        return refused("has the epoch " + number_of(index.epoch) + ", but its log has only " +
                       counted(head.size, "record") + ": it runs ahead");
    for (const SeenStamp& seen : state.stamps) {
        if (index.epoch < seen.epoch)
            return refused("has the epoch " + number_of(index.epoch) + ", older than " +
                           number_of(seen.epoch) +
                           ", which this terminal has seen: an old one is being replayed");
        if (index.epoch == seen.epoch && seen.releases_sha256 != releases_sha256(index))
            return refused("lists other releases than the index of the same epoch " + number_of(seen.epoch) +
                           " that this terminal has seen");
        if (seen.key == key && index.issued < seen.issued)
            return refused("was issued at " + utc_text(index.issued) +
                           ", before one that this terminal has seen (" + utc_text(seen.issued) +
                           "): an old one is being replayed");
    }
    return {};
}

Status check_log(const TerminalState& state, const LogHead& head, const ConsistencyCheck& consistent) {
    if (!state.tree_head) return {};
    const LogHead& seen = state.tree_head->head;
    if (head.size < seen.size)
        return refused("comes with a log of " + counted(head.size, "record") +
                           ", but this terminal has seen one of " + number_of(seen.size) +
                           ": records were taken away or an old log is shown",
                       "index.tree_head");
    if (head.size == seen.size && head.root == seen.root) return {};
    if (head.size == seen.size)
        return refused("comes with another log of " + counted(head.size, "record") +
                           " than this terminal has seen: history was rewritten",
                       "index.tree_head");
    if (!consistent)
        return refused("comes without a proof that its log goes on from the one seen before",
                       "index.tree_head");
    if (const Status proven = consistent(seen, head); !proven)
        return refused(
            "comes with a log that does not go on from the one seen before: " + proven.error().message,
            "index.tree_head");
    return {};
}

Status check_entry(const SeenRelease& seen, const IndexEntry* entry) {
    const std::string name = "release " + number_of(seen.number);
    if (entry == nullptr) return refused("does not list " + name + " any more, which this terminal has seen");
    if (entry->revision_sha256 != seen.revision_sha256)
        return refused("lists " + name + " with another revision than this terminal has seen");
    if (entry->state < seen.state)
        return refused("calls " + name + " " + name_of(entry->state) + ", but it was " + name_of(seen.state) +
                       " before, which is final");
    return {};
}

Status check_history(const TerminalState& state, const ReleaseIndex& index) {
    auto entry = index.releases.begin();  // both are sorted by number
    for (const SeenRelease& seen : state.releases) {
        while (entry != index.releases.end() && entry->number < seen.number) ++entry;
        const bool listed = entry != index.releases.end() && entry->number == seen.number;
        WEAVE_CHECK_OK(check_entry(seen, listed ? &*entry : nullptr));
    }
    return {};
}

void remember_releases(TerminalState& state, const ReleaseIndex& index) {
    std::vector<SeenRelease> seen;
    auto before = state.releases.begin();
    for (const IndexEntry& entry : index.releases) {
        SeenRelease now{entry.number, entry.revision_sha256, entry.state, ""};
        if (before != state.releases.end() && before->number == entry.number)
            now.body_sha256 = (before++)->body_sha256;
        seen.push_back(std::move(now));
    }
    state.releases = std::move(seen);
}

void remember_stamp(TerminalState& state, const std::string& key, const ReleaseIndex& index) {
    SeenStamp stamp{key, index.epoch, index.issued, releases_sha256(index)};
    const auto place =
        std::lower_bound(state.stamps.begin(), state.stamps.end(), key,
                         [](const SeenStamp& seen, const std::string& id) { return seen.key < id; });
    if (place != state.stamps.end() && place->key == key)
        *place = std::move(stamp);
    else
        state.stamps.insert(place, std::move(stamp));
}

/// The key that stamped an index which open_index() took.
std::vector<std::string> stamping_keys(std::string_view index_bytes) {
    std::vector<std::string> keys;
    const auto document = read_signed(index_bytes, most_index_bytes);
    if (document)
        for (const Signature& signature : document->signatures) keys.push_back(signature.key);
    return keys;
}

bool knows(const TrustDocument& trust, const std::string& id, Role role) {
    const TrustedKey* key = trust.find(id);
    return key != nullptr && key->has(role);
}

}  // namespace

Result<TerminalState> adopt_trust(const TerminalState& state, std::span<const std::string> documents) {
    TerminalState next = state;
    WEAVE_TRY(next.trust, follow_trust(state.trust, documents));
    const std::size_t dropped = std::erase_if(
        next.stamps, [&](const SeenStamp& seen) { return !knows(next.trust, seen.key, Role::stamp); });
    if (dropped > 0) {
        std::erase_if(next.releases, [](const SeenRelease& seen) { return seen.body_sha256.empty(); });
        for (SeenRelease& seen : next.releases) seen.state = ReleaseState::released;
    }
    if (next.tree_head && !check_head(*next.tree_head, next.trust)) next.tree_head.reset();
    return next;
}

Result<CheckedIndex> check_index(const TerminalState& state, std::string_view index_bytes, Instant now,
                                 const ConsistencyCheck& consistent) {
    auto opened = open_index(index_bytes, state.trust);
    if (!opened) return invalid(opened.error().message, opened.error().where).under("index");
    const ReleaseIndex& index = *opened;
    const LogHead& head = index.tree_head.head;
    WEAVE_CHECK_OK(check_subject(state, index));
    WEAVE_CHECK_OK(check_time(state, index, now));
    const auto keys = stamping_keys(index_bytes);
    for (const std::string& key : keys) WEAVE_CHECK_OK(check_epoch(state, key, index, head));
    WEAVE_CHECK_OK(check_log(state, head, consistent));
    WEAVE_CHECK_OK(check_history(state, index));
    CheckedIndex checked{index, state};
    for (const std::string& key : keys) remember_stamp(checked.state, key, index);
    checked.state.tree_head = index.tree_head;
    remember_releases(checked.state, index);
    checked.state.last_seen = std::max(state.last_seen, now);
    return checked;
}

}  // namespace weave::loomlink
