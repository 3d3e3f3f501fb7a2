#include <simd/service/local_tokens.hpp>

#include <weave/keys/codes.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/private_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <simd/service/visitors.hpp>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

namespace weave::simd {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 20, longest_name = 100, hash_characters = 64;

Status check_name(const std::string& person) {
    const bool fits = !person.empty() && person.size() <= longest_name && person != local_person_name &&
                      std::ranges::all_of(person, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_'; });
    if (fits) return {};
    return Error{ErrorCode::usage, "a name is of a-z, 0-9, '.', '-' and '_', at most 100 of them, and not 'local'", person};
}

/// What the machine's administrator writes for a daemon of another user is to be that user's.
Status belong_to_folder(const std::filesystem::path& file) {
    struct stat folder{};
    const std::filesystem::path above = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    if (::geteuid() != 0 || ::stat(above.c_str(), &folder) != 0 || folder.st_uid == 0) return {};
    if (::chown(file.c_str(), folder.st_uid, folder.st_gid) == 0) return {};
    return system_fault(std::string("cannot be given to the owner of its folder: ") + std::strerror(errno), file.string());
}

Status save(const std::filesystem::path& file, const std::map<std::string, std::string>& people) {
    std::string text;
    for (const auto& [hash, person] : people) text += person + " " + hash + "\n";
    WEAVE_CHECK_OK(write_private_file(file, text));
    return belong_to_folder(file);
}

}  // namespace

Result<std::map<std::string, std::string>> parse_local_tokens(std::string_view text) {
    std::map<std::string, std::string> people;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::size_t space = line.find(' ');
        const std::string person = line.substr(0, space), hash = space == std::string::npos ? "" : line.substr(space + 1);
        if (!is_hex(hash, hash_characters) || !check_name(person))
            return bad_input("must be a name and the SHA-256 of a token", "line " + std::to_string(number));
        people[hash] = person;
    }
    return people;
}

Result<std::map<std::string, std::string>> read_local_tokens(const std::filesystem::path& file) {
    std::error_code missing;
    if (file.empty() || !std::filesystem::exists(file, missing)) return std::map<std::string, std::string>();
    WEAVE_TRY(const SecretBytes bytes, read_private_file(file, most_bytes));
    auto people = parse_local_tokens({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (!people) return std::move(people).error().in(file.string());
    return people;
}

Result<std::string> add_local_token(const std::filesystem::path& file, const std::string& person) {
    WEAVE_CHECK_OK(check_name(person));
    WEAVE_TRY(auto people, read_local_tokens(file));
    std::erase_if(people, [&](const auto& entry) { return entry.second == person; });
    const std::string token = make_token();
    people[token_hash(token)] = person;
    WEAVE_CHECK_OK(save(file, people));
    return token;
}

Status remove_local_token(const std::filesystem::path& file, const std::string& person) {
    WEAVE_TRY(auto people, read_local_tokens(file));
    if (std::erase_if(people, [&](const auto& entry) { return entry.second == person; }) == 0)
        return Error{ErrorCode::refused, "has no token", person};
    return save(file, people);
}

}  // namespace weave::simd
