#include <weave/keys/signer.hpp>

#include <weave/core/file.hpp>
#include <weave/core/json_reader.hpp>
#include <weave/keys/members.hpp>
#include <weave/keys/server_key.hpp>

#include <utility>

namespace weave {

namespace fs = std::filesystem;

namespace {

constexpr const char* format = "weave-signer";
constexpr std::size_t most_bytes = 4096, key_characters = 64;

Result<SignerNote> read_note(std::string_view bytes) {
    WEAVE_TRY(const Json json, parse_json(bytes));
    JsonReader reader(json, "");
    read_heading(reader, format);
    SignerNote note{hex_member(reader, "key", key_characters), name_member(reader, "site"), name_member(reader, "name")};
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return note;
}

}  // namespace

fs::path signer_note(const fs::path& key_file) {
    return key_file.string() + ".site";
}

Status save_signer_note(const fs::path& key_file, const SignerNote& note) {
    const std::string bytes = canonical_json(
        {{"format", format}, {"version", 1}, {"key", note.key}, {"site", note.site}, {"name", note.name}});
    if (const auto read = read_note(bytes); !read) return read.error();
    return write_file(signer_note(key_file), bytes + "\n");
}

Result<Signer> load_signer(const fs::path& key_file) {
    WEAVE_TRY(KeyPair key, load_server_key(key_file, ServerKeyRole::evidence));
    const fs::path file = signer_note(key_file);
    std::error_code trouble;
    if (!fs::exists(file, trouble))
        return bad_input("is missing; `loomlink signer enrol` writes it beside the key, and tells in it for which site the key signs",
                         file.string());
    WEAVE_TRY(const std::string bytes, read_file(file, most_bytes));
    auto note = read_note(bytes);
    if (!note) return std::move(note).error().in(file.string());
    if (note->key != key.id()) return bad_input("is of another key than the one beside it", file.string());
    return Signer{std::move(key), std::move(note->site), std::move(note->name)};
}

}  // namespace weave
