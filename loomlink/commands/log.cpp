// log and audit: what happened, and the proof that nothing of it was changed.

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/audit/head.hpp>
#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/log_words.hpp>
#include <loomlink/commands/names.hpp>
#include <loomlink/commands/verify_audit.hpp>

namespace weave::loomlink {

namespace {

constexpr std::int64_t most_page = 1000;
constexpr std::int64_t usual_limit = 100;

struct LogWords {
    std::string design;
    std::optional<std::int64_t> from, limit;
};

/// How many records the log has.
Result<std::int64_t> log_size(wire::MillClient& client) {
    WEAVE_TRY(const Json head, client.get("/audit/head"));
    return wire::number_member(head, "size");
}

/// Records from a number on, oldest first, at most `limit`; without a number, the newest ones.
Result<std::vector<Json>> records(wire::MillClient& client, const LogWords& words) {
    const std::int64_t limit = words.limit.value_or(usual_limit);
    std::int64_t from = words.from.value_or(0);
    if (!words.from && words.design.empty()) {
        WEAVE_TRY(const std::int64_t size, log_size(client));
        from = std::max<std::int64_t>(0, size - limit);
    }
    std::vector<Json> found;
    while (true) {
        net::Parameters query{{"from", std::to_string(from)}, {"limit", std::to_string(most_page)}};
        if (!words.design.empty()) query.emplace_back("design", words.design);
        WEAVE_TRY(const Json answer, client.get("/events", query));
        const auto page = entries(answer, "events");
        found.insert(found.end(), page.begin(), page.end());
        const auto many = static_cast<std::int64_t>(found.size());
        if (!words.from && many > limit) found.erase(found.begin(), found.end() - limit);
        if (words.from && many >= limit) found.resize(static_cast<std::size_t>(limit));
        if (static_cast<std::int64_t>(page.size()) < most_page || (words.from && many >= limit)) return found;
        WEAVE_TRY(const std::int64_t last, wire::number_member(page.back(), "seq"));
        from = last + 1;
    }
}

Status tell_log(wire::MillClient& client, const LogWords& words, CommandOutcome& outcome) {
    WEAVE_TRY(const auto found, records(client, words));
    std::vector<std::vector<std::string>> lines;
    for (const Json& record : found) lines.push_back(log_cells(record));
    outcome.answer({{"events", found}}, as_list(in_columns(lines)));
    return {};
}

void add_log(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "log", "Tell what happened: the newest records of the log",
                           "loomlink log --design shoe --limit 20");
    const auto words = std::make_shared<LogWords>();
    add_name(command.command, "--design", words->design, "only what is about this design")->type_name("NAME");
    command.command
        ->add_option_function<std::string>(
            "--from",
            [words](const std::string& word) {
                words->from = parse_whole(word);
                if (!words->from || *words->from < 0)
                    throw CLI::ValidationError("--from", "'" + word + "' is not a whole number from 0 on");
            },
            "begin with this record; they count from 0")
        ->type_name("N");
    add_number(command.command, "--limit", words->limit, "how many at most; 100 if not given");
    on_client_run(command, outcome,
                  [words, &outcome](wire::MillClient& client) { return tell_log(client, *words, outcome); });
}

/// The signed head as it is retained and exported.
Result<std::string> head_file(const Json& answer) {
    SignedTreeHead head;
    WEAVE_TRY(head.head.site, wire::text_member(answer, "site"));
    WEAVE_TRY(const std::int64_t size, wire::number_member(answer, "size"));
    head.head.size = static_cast<std::uint64_t>(size);
    WEAVE_TRY(const std::string root, wire::text_member(answer, "root"));
    const auto hash = parse_hash(root);
    if (!hash) return bad_input("is no hash", "root");
    head.head.root = *hash;
    WEAVE_TRY(head.head.at, wire::text_member(answer, "at"));
    WEAVE_TRY(head.signature, signature_from(answer.value("signature", Json()), "signature"));
    const std::string bytes = signed_head_bytes(head);
    WEAVE_CHECK_OK(parse_signed_head(bytes));
    return bytes;
}

Status tell_head(wire::MillClient& client, const std::string& out, CommandOutcome& outcome) {
    WEAVE_TRY(Json answer, client.get("/audit/head"));
    if (!out.empty()) {
        WEAVE_TRY(const std::string bytes, head_file(answer));
        WEAVE_CHECK_OK(write_file(out, bytes));
        answer["file"] = out;
    }
    outcome.answer(answer, told(answer, "site") + " at " + told(answer, "at") + ": " + told(answer, "size") +
                               " records, root " + told(answer, "root") + "\n");
    return {};
}

Status fetch_bundle(wire::MillClient& client, const std::string& out, CommandOutcome& outcome) {
    WEAVE_TRY(const std::string bytes, client.get_bytes("/audit/bundle", default_file_limit));
    WEAVE_CHECK_OK(write_file(out, bytes));
    outcome.answer({{"file", out}, {"bytes", bytes.size()}},
                   on_one_line(out) + ": the whole log; check it with loomlink audit verify\n");
    return {};
}

}  // namespace

void add_log_commands(CLI::App& app, CommandOutcome& outcome) {
    add_log(app, outcome);
    CLI::App& audit = add_group(app, "audit", "The log as a whole, with its proofs");
    const auto out = std::make_shared<std::string>();
    const auto head =
        add_client_command(audit, outcome, "head", "Tell the signed head of the log, and keep it for later",
                           "loomlink audit head -o head.json");
    add_text(head.command, "-o,--out", *out, "the file to keep it in, for audit verify --retained")
        ->type_name("FILE");
    on_client_run(head, outcome,
                  [out, &outcome](wire::MillClient& client) { return tell_head(client, *out, outcome); });
    const auto bundle =
        add_client_command(audit, outcome, "bundle", "Write the whole log to a file, to be verified offline",
                           "loomlink audit bundle -o log.json");
    add_text(bundle.command, "-o,--out", *out, "the file to write")->type_name("FILE")->required();
    on_client_run(bundle, outcome,
                  [out, &outcome](wire::MillClient& client) { return fetch_bundle(client, *out, outcome); });
    add_audit_verify(audit, outcome);
}

}  // namespace weave::loomlink
