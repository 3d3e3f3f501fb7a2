#include <loomlink/commands/puller.hpp>

#include <weave/core/descriptor.hpp>
#include <weave/core/exit_code.hpp>
#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/net/target.hpp>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <loomlink/audit/tree.hpp>
#include <loomlink/commands/trust_papers.hpp>
#include <loomlink/workflow/desk.hpp>
#include <sys/file.h>
#include <utility>

namespace weave::loomlink {

namespace fs = std::filesystem;

namespace {

/// Whether `papers`, oldest first, lead from one trust document to the one of this fingerprint, each signed as
/// the next of the one before. Those that are not the next, such as older ones, are passed over.
bool lead_to(const std::vector<std::string>& papers, TrustDocument from, const std::string& fingerprint) {
    for (const std::string& paper : papers) {
        if (from.fingerprint() == fingerprint) return true;
        if (auto next = next_trust(from, paper)) from = *std::move(next);
    }
    return from.fingerprint() == fingerprint;
}

/// The one of `papers` with this fingerprint, sound in itself; nothing where there is none.
std::optional<TrustDocument> paper_of(const std::vector<std::string>& papers, const std::string& fingerprint) {
    for (const std::string& paper : papers)
        if (auto trust = read_trust(paper); trust && trust->fingerprint() == fingerprint) return *std::move(trust);
    return {};
}

/// One pull, from its first question to the last file.
class Pull {
  public:
    Pull(wire::MillClient& client, const PullWish& wish) : m_client(&client), m_wish(&wish) {}

    Result<PullReport> run() {
        WEAVE_TRY(const Descriptor turn, take_turn());
        WEAVE_TRY(TerminalState state, known_state());
        WEAVE_TRY(CheckedIndex checked, fetch_index(std::move(state)));
        WEAVE_CHECK_OK(save_state(m_wish->state_file, checked.state));
        const TerminalState before = checked.state;
        RecallReport recall = remove_ended(checked.state, ReleaseState::withdrawn);
        checked.state = std::move(recall.state);
        WEAVE_CHECK_OK(save_state(m_wish->state_file, checked.state));
        PullReport report{{}, std::move(recall.removed), {}, std::move(recall.kept), {}, checked.index.expires};
        for (const std::uint64_t number : wanted(checked.index)) {
            auto held = hold(checked, number);
            if (held)
                report.releases.push_back(*std::move(held));
            else
                report.refused.push_back({number, std::move(held).error()});
        }
        const auto foreign = foreign_releases(before, checked.state, m_wish->to);
        WEAVE_CHECK_OK(remove_superseded(checked.state, report));
        report.kept.insert(report.kept.end(), foreign.begin(), foreign.end());
        return report;
    }

  private:
    static Instant now() { return system_clock()(); }

    /// The right to change state and folder, while it is held.
    [[nodiscard]] Result<Descriptor> take_turn() const {
        WEAVE_CHECK_OK(wire::make_folders_for(m_wish->state_file));
        const fs::path file = m_wish->state_file.string() + ".lock";
        Descriptor turn(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
        if (turn.number() < 0) return file_fault(file, "open");
        while (::flock(turn.number(), LOCK_EX) != 0)
            if (errno != EINTR) return file_fault(file, "lock");
        return turn;
    }

    /// Last, once what is in force lies there: a loom that loses its server in between still has something.
    Status remove_superseded(const TerminalState& state, PullReport& report) {
        RecallReport gone = remove_ended(state, ReleaseState::superseded);
        report.superseded = std::move(gone.removed);
        report.kept.insert(report.kept.end(), gone.kept.begin(), gone.kept.end());
        return save_state(m_wish->state_file, gone.state);
    }

    [[nodiscard]] std::string path(std::initializer_list<std::string> below) const {
        return wire::mill_path({"looms", m_wish->loom}) + wire::mill_path(below);
    }

    /// Refused where --trust names another mill than the one that the terminal trusts. A fingerprint of the same
    /// chain of documents, be it older or newer, is in order. Whatever it names, it takes the place of nothing.
    [[nodiscard]] Status check_wished_trust(const TrustDocument& known) const {
        if (m_wish->trust.empty() || m_wish->trust == known.fingerprint()) return {};
        WEAVE_TRY(const auto papers, trust_papers(*m_client));
        const auto meant = paper_of(papers, m_wish->trust);
        if (meant && (lead_to(papers, *meant, known.fingerprint()) || lead_to(papers, known, m_wish->trust))) return {};
        return Error{ErrorCode::refused,
                     "this terminal trusts document " + std::to_string(known.version) + " of the site '" + known.site +
                         "' with the fingerprint " + known.fingerprint() + ", and no document of this server leads from there to the " +
                         m_wish->trust + " of --trust, nor back: another mill, or somebody who stands in for one. "
                         "Nothing was changed. Ask an administrator, by another way than this network; for another mill give a "
                         "state of its own (--state) and a folder of its own (--to)",
                     m_wish->state_file.string()};
    }

    /// What the terminal remembers, or its first trust.
    Result<TerminalState> known_state() {
        std::error_code code;
        if (fs::exists(fs::symlink_status(m_wish->state_file, code))) {
            WEAVE_TRY(TerminalState state, load_state(m_wish->state_file));
            if (state.loom != m_wish->loom)
                return Error{ErrorCode::refused, "is the state of the loom '" + state.loom + "'",
                             m_wish->state_file.string()};
            WEAVE_CHECK_OK(check_wished_trust(state.trust));
            return state;
        }
        if (m_wish->trust.empty())
            return Error{ErrorCode::usage,
                         "this terminal trusts nobody yet: give the fingerprint of the site's trust document "
                         "with --trust; ask an administrator for it, by another way than this network",
                         m_wish->state_file.string()};
        WEAVE_TRY(const auto papers, trust_papers(*m_client));
        if (papers.empty())
            return Error{ErrorCode::refused, "nobody has signed a trust document yet", "trust"};
        const auto meant = paper_of(papers, m_wish->trust);
        return first_state(m_wish->loom, meant ? write_signed(meant->document) : papers.back(), m_wish->trust);
    }

    /// The index with what the terminal needs to judge it. A head that the server cannot go on from is left
    /// out the second time: check_index() then says what is wrong with that.
    Result<Json> ask_for_index(const TerminalState& state) {
        net::Parameters query{{"trust", std::to_string(state.trust.version)}};
        if (!state.tree_head) return m_client->get(path({"index"}), query);
        auto with_head = query;
        with_head.emplace_back("head", std::to_string(state.tree_head->head.size));
        auto answer = m_client->get(path({"index"}), with_head);
        if (answer || answer.error().code != ErrorCode::bad_input) return answer;
        return m_client->get(path({"index"}), query);
    }

    Result<CheckedIndex> fetch_index(TerminalState state) {
        WEAVE_TRY(const Json answer, ask_for_index(state));
        WEAVE_TRY(const std::string index, wire::text_member(answer, "index"));
        WEAVE_TRY(const auto documents, wire::texts_member(answer, "trust"));
        WEAVE_CHECK_OK(wire::make_folders_for(m_wish->state_file));
        if (!documents.empty()) {  // kept whatever comes of the index: it may revoke a key
            WEAVE_TRY(state, adopt_trust(state, documents));
            WEAVE_CHECK_OK(save_state(m_wish->state_file, state));
        }
        return check_index(state, index, now(), [&](const LogHead& older, const LogHead& newer) {
            return check_growth(answer, older, newer);
        });
    }

    static Status check_growth(const Json& answer, const LogHead& older, const LogHead& newer) {
        WEAVE_TRY(const auto texts, wire::texts_member(answer, "consistency"));
        std::vector<Hash> proof;
        for (const std::string& text : texts) {
            const auto hash = parse_hash(text);
            if (!hash) return bad_input("the proof is no list of hashes");
            proof.push_back(*hash);
        }
        const auto old_root = parse_hash(older.root), root = parse_hash(newer.root);
        if (old_root && root && verify_consistency(older.size, *old_root, newer.size, *root, proof))
            return {};
        return bad_input("the proof does not fit");
    }

    [[nodiscard]] std::vector<std::uint64_t> wanted(const ReleaseIndex& index) const {
        if (m_wish->release) return {static_cast<std::uint64_t>(*m_wish->release)};
        std::vector<std::uint64_t> numbers;
        for (const IndexEntry& entry : index.releases)
            if (entry.state == ReleaseState::released) numbers.push_back(entry.number);
        if (!m_wish->all && numbers.size() > 1) numbers.erase(numbers.begin(), numbers.end() - 1);
        return numbers;
    }

    /// Whether these very files lie there already.
    [[nodiscard]] std::optional<fs::path> held_already(const CheckedIndex& checked,
                                                       std::uint64_t number) const {
        const IndexEntry* entry = checked.index.find(number);
        if (entry == nullptr || entry->state != ReleaseState::released) return {};
        for (const PlacedRelease& placed : checked.state.placed) {
            const fs::path folder = m_wish->to / placed.folder;
            if (placed.number != number || !lies_in(placed, m_wish->to)) continue;
            const auto manifest = read_file(folder / manifest_name, most_manifest_bytes);
            if (!manifest || sha256_hex(*manifest) != entry->manifest_sha256) continue;
            const auto report = verify_files(folder, checked.state.trust);
            if (report && report->findings.empty()) return folder;
        }
        return {};
    }

    Result<HeldRelease> hold(CheckedIndex& checked, std::uint64_t number) {
        if (auto folder = held_already(checked, number))
            return HeldRelease{number, *std::move(folder), false};
        WEAVE_CHECK_OK(check_listed(checked, number));
        const std::string name = std::to_string(number);
        WEAVE_TRY(const std::string bytes,
                  m_client->get_bytes(path({"releases", name, "manifest"}), most_manifest_bytes));
        auto manifest = check_manifest(bytes, checked.state.trust);
        if (!manifest) return std::move(manifest).error().under("manifest");
        std::vector<PulledFile> files;
        for (const ReleasedFile& file : manifest->files) {
            WEAVE_TRY(std::string content,
                      m_client->get_bytes(path({"releases", name, "files", file.path}), file.size));
            files.push_back({file.path, std::move(content)});
        }
        WEAVE_TRY(const CheckedRelease release,
                  check_release(checked, number, bytes, std::move(files), now()));
        WEAVE_TRY(fs::path folder, place_release(checked.state, release, m_wish->state_file, m_wish->to));
        return HeldRelease{number, std::move(folder), true};
    }

    /// Nothing is asked for that may not be woven: check_release() would refuse it, and says why best.
    Status check_listed(const CheckedIndex& checked, std::uint64_t number) const {
        const IndexEntry* entry = checked.index.find(number);
        if (entry != nullptr && entry->state == ReleaseState::released) return {};
        const auto refusal = check_release(checked, number, "", {}, now());
        return refusal ? Status() : Status(refusal.error());
    }

    wire::MillClient* m_client;
    const PullWish* m_wish;
};

}  // namespace

bool PullReport::has_news() const {
    const bool came =
        std::any_of(releases.begin(), releases.end(), [](const auto& one) { return one.is_new; });
    return came || !removed.empty() || !superseded.empty();
}

Json to_json(const PullReport& report, const std::string& loom) {
    Json releases = Json::array(), kept = Json::array(), refused = Json::array();
    for (const RefusedRelease& one : report.refused)
        refused.push_back({{"number", one.number}, {"error", error_json(one.error)}});
    for (const HeldRelease& held : report.releases)
        releases.push_back({{"number", held.number}, {"folder", held.folder.string()}, {"new", held.is_new}});
    for (const FileFinding& finding : report.kept)
        kept.push_back({{"file", finding.path}, {"message", finding.message}});
    Json json{{"loom", loom},
              {"releases", std::move(releases)},
              {"removed", report.removed},
              {"superseded", report.superseded},
              {"kept", std::move(kept)},
              {"refused", std::move(refused)},
              {"index_expires", utc_text(report.expires)}};
    if (!report.refused.empty()) json["error"] = error_json(report.refused.front().error);
    return json;
}

std::string in_words(const PullReport& report, const std::string& loom) {
    std::string words;
    for (const HeldRelease& held : report.releases)
        words += on_one_line(loom) + ", release " + std::to_string(held.number) + ": " +
                 on_one_line(held.folder.string()) + (held.is_new ? "\n" : " (as before)\n");
    for (const RefusedRelease& one : report.refused)
        words += on_one_line(loom) + ", release " + std::to_string(one.number) + ": NOT fetched: " +
                 on_one_line(one.error.text()) + "\n";
    if (report.releases.empty() && report.refused.empty()) words += on_one_line(loom) + ": no release is in force\n";
    for (const std::string& file : report.removed) words += "recalled, removed: " + on_one_line(file) + "\n";
    for (const std::string& file : report.superseded)
        words += "superseded, removed: " + on_one_line(file) + "\n";
    for (const FileFinding& finding : report.kept)
        words +=
            "MUST NOT BE WOVEN: " + on_one_line(finding.path) + " " + on_one_line(finding.message) + "\n";
    return words;
}

Result<fs::path> usual_state_file(const std::string& loom) {
    WEAVE_TRY(const fs::path folder, wire::user_folder("XDG_STATE_HOME", ".local/state"));
    return folder / "loomlink" / (net::percent_encoded(loom) + ".json");
}

Result<PullReport> pull(wire::MillClient& client, const PullWish& wish) {
    return Pull(client, wish).run();
}

}  // namespace weave::loomlink
