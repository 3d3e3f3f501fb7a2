#include <weave/ranks/checkpoint.hpp>

#include <weave/core/file.hpp>
#include <weave/core/json_reader.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/sim/yarns_file.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

namespace weave::ranks {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view step_prefix = "step-", complete_name = "complete.json";
constexpr std::uint64_t longest_part = std::uint64_t{16} << 30;
constexpr std::int64_t most_ranks = 1 << 20, most_blocks = 1 << 24;

std::string part_name(std::size_t rank) {
    return "rank-" + std::to_string(rank) + ".part";
}

bool is_part(std::string_view name) {
    return name.starts_with("rank-") && name.ends_with(".part") && parse_whole(name.substr(5, name.size() - 10)).has_value();
}

/// The step of a checkpoint's folder, by its name.
std::optional<std::size_t> step_of(const fs::path& folder) {
    const std::string name = folder.filename().string();
    if (!name.starts_with(step_prefix)) return {};
    const auto step = parse_whole(std::string_view(name).substr(step_prefix.size()));
    if (!step || *step < 0 || name != std::string(step_prefix) + std::to_string(*step)) return {};
    return static_cast<std::size_t>(*step);
}

Status make_folder(const fs::path& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) return system_fault("cannot create: " + code.message(), folder.string());
    return {};
}

std::vector<double> numbers_in(std::string_view bytes) {
    std::vector<double> numbers(bytes.size() / 8);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        std::uint64_t word = 0;
        for (std::size_t b = 8; b-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[8 * k + b]);
        numbers[k] = std::bit_cast<double>(word);
    }
    return numbers;
}

/// A rank's file: a line of JSON that says what follows, and the numbers of its blocks.
struct PartFile {
    std::int64_t first_block = 0;
    std::vector<std::size_t> points;  ///< of each block
    std::vector<double> numbers;
};

Result<PartFile> read_part(const fs::path& path) {
    WEAVE_TRY(const std::string bytes, read_file(path, longest_part));
    const std::size_t end = bytes.find('\n');
    if (end == std::string::npos) return bad_input("ends within its first line", path.string());
    auto json = parse_json(std::string_view(bytes).substr(0, end));
    if (!json) return std::move(json).error().in(path.string());
    const std::string_view rest = std::string_view(bytes).substr(end + 1);
    JsonReader reader(*json, "");
    PartFile part;
    part.first_block = reader.integer("first_block", 0, most_blocks);
    const std::string hash = reader.text("sha256", {}, 64);
    const Json& points = reader.raw("points");
    std::size_t all = 0;
    for (const Json& count : points.is_array() ? points : Json::array()) {
        if (!count.is_number_unsigned() || count.get<std::uint64_t>() > most_file_points) return bad_input("is not a number of points", path.string() + ": points");
        part.points.push_back(count.get<std::size_t>());
        all += part.points.back();
    }
    reader.no_others();
    if (const Status status = reader.status(); !status) return Status(status).error().in(path.string());
    if (all > most_file_points || rest.size() != 24 * all) return bad_input("should hold " + std::to_string(24 * all) + " bytes of places and holds " + std::to_string(rest.size()), path.string());
    if (sha256_hex(rest) != hash) return bad_input("is damaged: its places are not those that were written", path.string());
    part.numbers = numbers_in(rest);
    return part;
}

}  // namespace

fs::path Checkpoints::place(std::size_t iterations) const {
    return m_folder / (std::string(step_prefix) + std::to_string(iterations));
}

Status Checkpoints::write_own(const Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Stand& stand) const {
    Json points = Json::array();
    for (const Part& part : parts) points.push_back(part.own.size());
    const std::string bytes = file_bytes(stand.state);
    const Json front{{"first_block", cut.blocks_of(comm.rank(), comm.size())[0]}, {"points", points}, {"sha256", sha256_hex(bytes)}};
    return write_file(place(stand.iterations) / part_name(comm.rank()), front.dump() + "\n" + bytes);
}

Status Checkpoints::try_out(Comm& comm) const {
    constexpr std::string_view name = ".weave-shared";
    std::string word(16, '\0');
    if (comm.is_first()) {
        std::random_device random;
        for (char& letter : word) letter = static_cast<char>('a' + random() % 26);
    }
    Status status = comm.is_first() ? make_folder(m_folder) : Status();
    if (comm.is_first() && status) status = write_file(m_folder / name, word);
    WEAVE_CHECK_OK(agreed(comm, status));
    Comm::Packet letters;
    for (const char letter : word) letters.push_back(static_cast<double>(letter));
    const std::vector<Comm::Packet> words = comm.gather(letters);
    std::string wanted;
    for (const double letter : words.front()) wanted += static_cast<char>(letter);
    if (!comm.is_first()) {
        const auto seen = read_file(m_folder / name, 64);
        if (!seen || *seen != wanted) status = system_fault("is not the folder that the first process sees: checkpoints need one that all processes share", m_folder.string());
        const fs::path own = m_folder / (std::string(name) + "-" + std::to_string(comm.rank()));
        std::error_code ignored;
        if (status) status = write_file(own, wanted);
        fs::remove(own, ignored);
    }
    status = agreed(comm, status);
    std::error_code ignored;
    if (comm.is_first()) fs::remove(m_folder / name, ignored);
    return status;
}

bool Checkpoints::is_complete(std::size_t step) const {
    std::error_code ignored;
    return fs::exists(place(step) / complete_name, ignored);
}

Status Checkpoints::write(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Stand& stand) const {
    // A run never comes to a step that it has a checkpoint of but by beginning there.
    if (comm.gather(comm.is_first() && is_complete(stand.iterations) ? 1.0 : 0.0).front() != 0) return {};
    WEAVE_CHECK_OK(agreed(comm, comm.is_first() ? make_folder(place(stand.iterations)) : Status()));
    WEAVE_CHECK_OK(agreed(comm, write_own(comm, cut, parts, stand)));
    Status status;
    if (comm.is_first()) {
        const Json complete{{"run", m_run}, {"ranks", comm.size()}, {"iterations", stand.iterations}, {"evaluations", stand.evaluations}, {"seconds", stand.seconds}};
        status = write_file(place(stand.iterations) / complete_name, complete.dump(1) + "\n");
    }
    WEAVE_CHECK_OK(agreed(comm, status));
    if (comm.is_first()) remove_others(stand.iterations);
    return {};
}

/// What cannot be removed is only older. Of a folder nothing goes but the files of a checkpoint, and it itself once it is empty.
void Checkpoints::remove_others(std::size_t step) const {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(m_folder, ignored)) {
        const auto other = step_of(entry.path());
        if (!other || *other == step || !entry.is_directory(ignored)) continue;
        fs::remove(entry.path() / complete_name, ignored);  // first: what is half removed does not count
        for (const fs::directory_entry& file : fs::directory_iterator(entry.path(), ignored)) {
            if (is_part(file.path().filename().string())) fs::remove(file.path(), ignored);
        }
        fs::remove(entry.path(), ignored);
    }
}

Result<std::optional<std::size_t>> Checkpoints::newest_step() const {
    std::optional<std::size_t> newest;
    std::error_code code;
    if (!fs::exists(m_folder, code)) return newest;
    for (const fs::directory_entry& entry : fs::directory_iterator(m_folder, code)) {
        const auto step = step_of(entry.path());
        if (step && is_complete(*step) && (!newest || *step > *newest)) newest = step;
    }
    if (code) return system_fault("cannot be read: " + code.message(), m_folder.string());
    return newest;
}

Result<Stand> Checkpoints::read_own(const Comm& comm, const Cut& cut, const std::vector<Part>& parts, std::size_t step) const {
    const std::string where = (place(step) / complete_name).string();
    WEAVE_TRY(const std::string text, read_file(where));
    auto json = parse_json(text);
    if (!json) return std::move(json).error().in(where);
    JsonReader reader(*json, "");
    const std::int64_t ranks = reader.integer("ranks", 1, most_ranks);
    Stand stand;
    stand.iterations = static_cast<std::size_t>(reader.integer("iterations", 0, std::int64_t{1} << 52));
    stand.evaluations = static_cast<std::size_t>(reader.integer("evaluations", 0, std::int64_t{1} << 52));
    stand.seconds = reader.number("seconds", {0, 1e12});
    const Json run = reader.raw("run");
    reader.no_others();
    if (const Status status = reader.status(); !status) return Status(status).error().in(where);
    if (run != m_run) return Error{ErrorCode::refused, "is of another design, scene or plan: name another folder, or remove this one", m_folder.string()};
    const auto [first, last] = cut.blocks_of(comm.rank(), comm.size());
    std::size_t block = first;
    for (std::int64_t rank = 0; rank < ranks && block < last; ++rank) {
        const auto [its_first, its_last] = cut.blocks_of(static_cast<std::size_t>(rank), static_cast<std::size_t>(ranks));
        if (its_last <= block || its_first >= last) continue;
        const fs::path path = place(step) / part_name(static_cast<std::size_t>(rank));
        WEAVE_TRY(const PartFile part, read_part(path));
        if (static_cast<std::size_t>(part.first_block) != its_first || part.points.size() != its_last - its_first) return bad_input("holds other blocks than it should", path.string());
        auto at = part.numbers.begin();
        for (std::size_t b = its_first; b < its_last; ++b) {
            const auto end = at + static_cast<std::ptrdiff_t>(3 * part.points[b - its_first]);
            if (b == block && block < last) {
                if (part.points[b - its_first] != parts[b - first].own.size()) return bad_input("holds another number of points than the plan", path.string());
                if (!std::all_of(at, end, [](double number) { return std::abs(number) <= farthest_place_mm; })) return bad_input("holds what is no place within 1e9 mm", path.string());
                stand.state.insert(stand.state.end(), at, end);
                ++block;
            }
            at = end;
        }
    }
    return stand;
}

Result<std::optional<Stand>> Checkpoints::newest(Comm& comm, const Cut& cut, const std::vector<Part>& parts) const {
    // All take the one that the first rank sees.
    auto found = comm.is_first() ? newest_step() : Result<std::optional<std::size_t>>(std::optional<std::size_t>());
    WEAVE_CHECK_OK(agreed(comm, found ? Status() : Status(found.error())));
    const std::vector<double> steps = comm.gather(*found ? static_cast<double>(**found) : -1.0);
    if (steps.front() < 0) return std::optional<Stand>();
    auto stand = read_own(comm, cut, parts, static_cast<std::size_t>(steps.front()));
    WEAVE_CHECK_OK(agreed(comm, stand ? Status() : Status(stand.error())));
    return std::optional(*std::move(stand));
}

}  // namespace weave::ranks
