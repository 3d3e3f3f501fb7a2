#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>

#include <simd/worker/checkpoint.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::simd {

namespace {

constexpr std::string_view heading = "weave checkpoint 1\n";
constexpr std::size_t hash_bytes = 64;
constexpr std::uint64_t most_bytes = std::uint64_t{16} << 30;

Json optional_json(const std::optional<std::uint64_t>& number) {
    return number ? Json(*number) : Json();
}

}  // namespace

std::filesystem::path checkpoint_path(const std::filesystem::path& folder) {
    return folder / "checkpoint";
}

Status write_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
    std::string body;
    Json::to_cbor(Json{{"step", checkpoint.step},
                       {"changes", checkpoint.changes},
                       {"flip", optional_json(checkpoint.flip)},
                       {"run", checkpoint.run}},
                  body);
    return write_file(checkpoint_path(folder), std::string(heading) + sha256_hex(body) + "\n" + body);
}

Result<std::optional<Checkpoint>> read_checkpoint(const std::filesystem::path& folder) {
    const std::filesystem::path path = checkpoint_path(folder);
    std::error_code missing;
    if (!std::filesystem::exists(path, missing)) return std::optional<Checkpoint>();
    WEAVE_TRY(const std::string bytes, read_file(path, most_bytes));
    const std::string_view text(bytes);
    const std::size_t begin = heading.size() + hash_bytes + 1;
    if (!text.starts_with(heading) || text.size() < begin) return bad_input("is no checkpoint of this version", path.string());
    const std::string_view body = text.substr(begin);
    if (sha256_hex(body) != text.substr(heading.size(), hash_bytes)) return bad_input("was damaged", path.string());
    try {
        const Json json = Json::from_cbor(body);
        Checkpoint checkpoint{json.at("step"), json.at("changes"), {}, json.at("run")};
        if (!json.at("flip").is_null()) checkpoint.flip = json.at("flip").get<std::uint64_t>();
        return std::optional<Checkpoint>(std::move(checkpoint));
    } catch (const Json::exception& broken) {
        return bad_input(std::string("was damaged: ") + broken.what(), path.string());
    }
}

}  // namespace weave::simd
