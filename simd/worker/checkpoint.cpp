#include <simd/worker/checkpoint.hpp>

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>

#include <string>
#include <string_view>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::string_view heading = "weave checkpoint 1\n";
constexpr std::size_t hash_bytes = 64;
constexpr std::uint64_t most_bytes = std::uint64_t{16} << 30;

Result<std::uint64_t> number_of(const Json& json, const char* member) {
    if (!json.contains(member) || !json.at(member).is_number_unsigned()) return bad_input("was damaged", member);
    return json.at(member).get<std::uint64_t>();
}

}  // namespace

std::filesystem::path checkpoint_path(const std::filesystem::path& folder) {
    return folder / "checkpoint";
}

Status write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
    std::string body;
    Json::to_cbor(Json{{"step", checkpoint.step},
                       {"changes", checkpoint.changes},
                       {"run", checkpoint.run}},
                  body);
    return write_file(checkpoint_path(folder), std::string(heading) + sha256_hex(body) + "\n" + body);
}

Result<Checkpoint> parse_checkpoint(std::string_view bytes) try {
    const std::size_t begin = heading.size() + hash_bytes + 1;
    if (!bytes.starts_with(heading) || bytes.size() < begin || bytes[begin - 1] != '\n') return bad_input("is no checkpoint of this version");
    const std::string_view body = bytes.substr(begin);
    if (sha256_hex(body) != bytes.substr(heading.size(), hash_bytes)) return bad_input("was damaged");
    const Json json = Json::from_cbor(body, true, false);
    if (!json.is_object()) return bad_input("was damaged");
    Checkpoint checkpoint;
    WEAVE_TRY(checkpoint.step, number_of(json, "step"));
    WEAVE_TRY(checkpoint.changes, number_of(json, "changes"));
    if (!json.contains("run")) return bad_input("was damaged", "run");
    checkpoint.run = json.at("run");
    return checkpoint;
} catch (const Json::exception&) {  // sizes that no memory has are thrown, whatever is asked for
    return bad_input("was damaged");
}

Result<std::optional<Checkpoint>> read_checkpoint(const std::filesystem::path& folder) {
    const std::filesystem::path path = checkpoint_path(folder);
    std::error_code missing;
    if (!std::filesystem::exists(path, missing)) return std::optional<Checkpoint>();
    WEAVE_TRY(const std::string bytes, read_file(path, most_bytes));
    auto checkpoint = parse_checkpoint(bytes);
    if (!checkpoint) return Error{checkpoint.error().code, checkpoint.error().message, path.string()};
    return std::optional<Checkpoint>(std::move(*checkpoint));
}

}  // namespace weave::simd
