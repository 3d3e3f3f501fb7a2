#include <weave/keys/server_key.hpp>

#include <weave/keys/hex.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/sodium.hpp>

#include <algorithm>
#include <array>
#include <sodium.h>

namespace weave {

namespace {

// A key file is a line that says what it is, a line with the seed, and a line with the key's id, which shows
// damage.
constexpr std::size_t seed_characters = 2 * KeyPair::seed_bytes, id_characters = 64;

constexpr std::array headings{std::string_view("weave server key v1 log\n"),
                              std::string_view("weave server key v1 stamp\n"),
                              std::string_view("weave server key v1 evidence\n"),
                              std::string_view("weave server key v1 access\n")};

std::string_view heading_of(ServerKeyRole role) {
    return headings[static_cast<std::size_t>(role)];
}

std::string_view view_of(const SecretBytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Result<KeyPair> create_server_key(const std::filesystem::path& path, ServerKeyRole role) {
    KeyPair pair = KeyPair::generate();
    std::string text(heading_of(role));
    std::string seed = to_hex({pair.seed().data(), KeyPair::seed_bytes});
    text.reserve(text.size() + seed_characters + id_characters + 2);  // so that no copy stays behind unwiped
    text.append(seed).append("\n").append(pair.id()).append("\n");
    Status made = create_private_file(path, text);
    wipe(seed);
    wipe(text);
    if (!made) return std::move(made).error();
    return pair;
}

Result<KeyPair> load_server_key(const std::filesystem::path& path, ServerKeyRole role) {
    constexpr std::size_t most = 256;
    WEAVE_TRY(const SecretBytes bytes, read_private_file(path, most));
    std::string_view text = view_of(bytes);
    const std::string_view heading = heading_of(role);
    const bool known = std::any_of(headings.begin(), headings.end(),
                                   [&](std::string_view one) { return text.starts_with(one); });
    if (known && !text.starts_with(heading))
        return Error{ErrorCode::refused, "is a key for another use", path.string()};
    if (!known) return bad_input("is not a server key of version 1", path.string());
    text.remove_prefix(heading.size());
    SecretBytes seed(KeyPair::seed_bytes);
    const bool shaped = text.size() == seed_characters + id_characters + 2 && text[seed_characters] == '\n' &&
                        text.back() == '\n' &&
                        from_hex(text.substr(0, seed_characters), {seed.data(), seed.size()});
    if (!shaped) return bad_input("is a damaged server key", path.string());
    KeyPair pair = KeyPair::from_seed(seed);
    if (pair.id() != text.substr(seed_characters + 1, id_characters))
        return bad_input("is a damaged server key", path.string());
    return pair;
}

}  // namespace weave
