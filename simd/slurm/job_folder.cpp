#include <simd/slurm/job_folder.hpp>

#include <weave/core/file.hpp>
#include <weave/core/json_reader.hpp>
#include <weave/core/log.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <simd/link/error_form.hpp>
#include <sys/stat.h>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::uint64_t most_order_bytes = std::uint64_t{128} << 20, most_told_bytes = std::uint64_t{2} << 20;
const std::vector<std::string> outcome_names{"done", "again", "never"};
constexpr std::int64_t most_number = (std::int64_t{1} << 53) - 1;

/// What `make` makes of a JSON file; what it throws of members that are not as they should be is an error of the file.
template <class Make>
auto read_json(const std::filesystem::path& file, std::uint64_t most_bytes, Make make) -> decltype(make(std::declval<const Json&>())) {
    WEAVE_TRY(const std::string text, read_file(file, most_bytes));
    auto json = parse_json(text);
    if (!json) return std::move(json).error().in(file.string());
    try {
        auto made = make(*json);
        if (!made) return std::move(made).error().in(file.string());
        return made;
    } catch (const Json::exception& fault) {
        return bad_input(std::string("is not as this program writes it: ") + fault.what(), file.string());
    }
}

bool is_there(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
}

Status make_folder(const std::filesystem::path& path) {
    std::error_code code;
    std::filesystem::create_directories(path, code);
    return code ? Status(system_fault("cannot be made: " + code.message(), path.string())) : Status();
}

Json json_of(const AttemptEnd& end) {
    return {{"outcome", outcome_names[static_cast<std::size_t>(end.outcome)]},
            {"input_sha256", end.input_sha256},
            {"node", end.node},
            {"was_stopped", end.was_stopped},
            {"is_the_nodes_fault", end.is_the_nodes_fault},
            {"step", end.step},
            {"error", end.error ? to_json(*end.error) : Json()},
            {"report", end.report}};
}

Result<AttemptEnd> end_from(const Json& json) {
    JsonReader reader(json, "");
    AttemptEnd end;
    end.outcome = static_cast<Outcome>(reader.choice("outcome", outcome_names));
    end.input_sha256 = reader.text("input_sha256", {}, 64);
    end.node = reader.text("node", {}, 1000);
    end.was_stopped = reader.boolean("was_stopped");
    end.is_the_nodes_fault = reader.boolean("is_the_nodes_fault");
    end.step = static_cast<std::uint64_t>(reader.integer("step", 0, most_number));
    const Json& error = reader.raw("error");
    if (!error.is_null()) {
        end.error = error_from(error);
        end.error->message = on_one_line(end.error->message);
        end.error->where = on_one_line(end.error->where);
    }
    end.report = reader.raw("report");
    if (!end.report.is_object()) reader.fail("must be an object", "report");
    WEAVE_CHECK_OK(reader.status());
    return end;
}

Result<AttemptNews> news_from(const Json& json) {
    JsonReader reader(json, "");
    AttemptNews news;
    news.node = reader.text("node", {}, 1000);
    news.gpus = reader.text("gpus", {}, 1000);
    news.points = static_cast<std::size_t>(reader.integer("points", 0, most_number));
    news.step = static_cast<std::uint64_t>(reader.integer("step", 0, most_number));
    news.residual = reader.number("residual", {0, 1e300});
    news.goal = reader.number("goal", {0, 1e300});
    if (reader.has("lost")) news.lost = static_cast<std::uint64_t>(reader.integer("lost", 0, most_number));
    news.trouble = reader.text("trouble", {}, 65536);
    WEAVE_CHECK_OK(reader.status());
    return news;
}

}  // namespace

std::string input_sha256(const WorkOrder& order) {
    return sha256_hex(canonical_json({{"document", order.document}, {"simulation", simulation_text(order.simulation, order.flips)}}));
}

Status JobFolder::give(const WorkOrder& order) const {
    if (is_there(m_path / "order.json")) return {};
    WEAVE_CHECK_OK(make_folder(m_path / "attempts"));
    return write_file(m_path / "order.json", canonical_json(to_json(order)));
}

Result<WorkOrder> JobFolder::order() const {
    return read_json(m_path / "order.json", most_order_bytes, [](const Json& json) { return work_order_from(json); });
}

bool JobFolder::is_gone() const {
    std::error_code code;
    return !std::filesystem::exists(m_path / "order.json", code) && !code;
}

/// A file that cannot be written now is tried again by whoever asks for it as long as copies run.
void JobFolder::ask_to_stop(Stop stop) const {
    if (this->stop() == stop || !is_there(m_path)) return;
    const Status written = write_file(m_path / "stop", stop == Stop::with_yarns ? "with yarns\n" : "at once\n");
    if (!written) log(LogLevel::warning, written.error().text());
}

std::optional<Stop> JobFolder::stop() const {
    if (!is_there(m_path / "stop")) return {};
    const auto text = read_file(m_path / "stop", 100);
    return text && *text == "with yarns\n" ? Stop::with_yarns : Stop::at_once;
}

std::filesystem::path JobFolder::attempt(std::uint64_t number) const {
    return m_path / "attempts" / std::to_string(number);
}

Result<std::uint64_t> JobFolder::newest_attempt() const {
    std::error_code code;
    std::uint64_t newest = 0;
    std::filesystem::directory_iterator entries(m_path / "attempts", code);
    for (; !code && entries != std::filesystem::directory_iterator(); entries.increment(code)) {
        const auto number = parse_whole(entries->path().filename().string());
        if (number && *number > 0 && *number <= most_number) newest = std::max(newest, static_cast<std::uint64_t>(*number));
    }
    if (code) return system_fault("cannot be read: " + code.message(), (m_path / "attempts").string());
    return newest;
}

/// The system makes a folder once, on a network's file system too: so no two copies have one number.
Result<std::uint64_t> JobFolder::begin_attempt() const {
    WEAVE_TRY(std::uint64_t number, newest_attempt());
    while (::mkdir(attempt(++number).c_str(), 0700) != 0) {
        if (errno != EEXIST) return system_fault(std::string("cannot be made: ") + std::strerror(errno), attempt(number).string());
    }
    return number;
}

void JobFolder::tell(std::uint64_t attempt, const AttemptNews& news) const {
    Json json{{"node", news.node}, {"gpus", news.gpus}, {"points", news.points}, {"step", news.step},
              {"residual", news.residual}, {"goal", news.goal}, {"trouble", news.trouble}};
    if (news.lost) json["lost"] = *news.lost;
    const Status written = write_file(this->attempt(attempt) / "news.json", canonical_json(json));
    if (!written) log(LogLevel::warning, written.error().text());
}

std::optional<AttemptNews> JobFolder::news(std::uint64_t attempt) const {
    const std::filesystem::path file = this->attempt(attempt) / "news.json";
    if (!is_there(file)) return {};
    auto news = read_json(file, most_told_bytes, news_from);
    return news ? std::optional(std::move(*news)) : std::nullopt;
}

Status JobFolder::end(std::uint64_t attempt, const AttemptEnd& end) const {
    return write_file(this->attempt(attempt) / "end.json", canonical_json(json_of(end)));
}

void JobFolder::refuse(std::uint64_t attempt) const {
    std::error_code ignored;
    std::filesystem::rename(this->attempt(attempt) / "end.json", this->attempt(attempt) / "refused.json", ignored);
}

Result<std::optional<AttemptEnd>> JobFolder::end_of(std::uint64_t attempt) const {
    const std::filesystem::path file = this->attempt(attempt) / "end.json";
    if (!is_there(file)) return std::optional<AttemptEnd>();
    WEAVE_TRY(AttemptEnd end, read_json(file, most_told_bytes, end_from));
    return std::optional(std::move(end));
}

Status write_array(const std::filesystem::path& file, const std::vector<std::pair<std::uint64_t, std::uint64_t>>& jobs_by_place) {
    WEAVE_CHECK_OK(make_folder(file.parent_path()));
    Json jobs = Json::array();
    for (const auto& [place, job] : jobs_by_place) jobs.push_back({{"place", place}, {"job", job}});
    return write_file(file, canonical_json({{"jobs", std::move(jobs)}}));
}

Result<std::uint64_t> job_at(const std::filesystem::path& file, std::uint64_t place) {
    return read_json(file, most_told_bytes, [&](const Json& json) -> Result<std::uint64_t> {
        for (const Json& entry : json.at("jobs")) {
            if (entry.at("place") == place) return entry.at("job").get<std::uint64_t>();
        }
        return bad_input("has no job at place " + std::to_string(place));
    });
}

}  // namespace weave::simd
