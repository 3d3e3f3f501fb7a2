#include <simd/slurm/slurm.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <simd/slurm/process.hpp>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::chrono::seconds patience{60};

/// The last line that is not empty, where programs of Slurm say what it came to.
std::string last_line(std::string_view text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
    const std::size_t begin = text.rfind('\n');
    return on_one_line(begin == std::string_view::npos ? text : text.substr(begin + 1));
}

/// What may be behind words of Slurm that do not say it.
std::string hint(const std::string& told) {
    const auto has = [&](std::string_view word) { return told.find(word) != std::string::npos; };
    // slurmctld closes the connection of whom it does not believe, without a word.
    if (has("Zero Bytes were transmitted") || has("uthentication") || has("unge"))
        return " (munged must run here with the cluster's key, and the clocks of this machine and of the cluster must be the same to some minutes)";
    if (has("nable to contact slurm controller") || has("onnection")) return " (slurmctld does not answer: jobs that run go on meanwhile)";
    return {};
}

std::optional<std::uint64_t> number_in(std::string_view text) {
    const auto number = parse_whole(text);
    if (!number || *number < 0) return {};
    return static_cast<std::uint64_t>(*number);
}

}  // namespace

bool QueuedJob::is_alive() const {
    constexpr std::array<std::string_view, 13> alive{"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "SUSPENDED", "STOPPED", "REQUEUED",
                                                     "REQUEUE_HOLD", "REQUEUE_FED", "SPECIAL_EXIT", "RESIZING", "SIGNALING", "STAGE_OUT"};
    return std::ranges::find(alive, state) != alive.end();
}

std::string ranges_text(const std::vector<std::uint64_t>& places) {
    std::string text;
    for (std::size_t k = 0; k < places.size();) {
        std::size_t last = k;
        while (last + 1 < places.size() && places[last + 1] == places[last] + 1) ++last;
        text += (text.empty() ? "" : ",") + std::to_string(places[k]);
        if (last > k) text += "-" + std::to_string(places[last]);
        k = last + 1;
    }
    return text;
}

std::optional<std::uint64_t> parse_submitted(std::string_view text) {
    return number_in(text.substr(0, text.find_first_of(";\n")));
}

std::vector<QueuedJob> parse_queue(std::string_view text) {
    constexpr std::size_t most_fields = 6;
    std::vector<QueuedJob> jobs;
    while (!text.empty()) {
        std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        std::array<std::string_view, most_fields> fields;
        std::size_t k = 0;
        for (; k + 1 < most_fields; ++k) {
            const std::size_t end = line.find('|');
            if (end == std::string_view::npos) break;
            fields[k] = line.substr(0, end);
            line.remove_prefix(end + 1);
        }
        const auto array = number_in(fields[0]), place = number_in(fields[1]);
        if (k + 1 < most_fields || !array || !place) continue;  // others of this user, that are no arrays
        jobs.push_back({*array, *place, std::string(fields[2]), std::string(fields[3]), std::string(fields[4]), std::string(line)});
    }
    return jobs;
}

Result<std::string> Slurm::ask(const std::vector<std::string>& words) const {
    auto answered = run_command(words, patience, m_gives_up);
    if (!answered) return std::move(answered).error().in("Slurm");
    if (answered->status == 0) return std::move(answered->answer);
    const std::string told = last_line(answered->told);
    return system_fault((told.empty() ? words.front() + " ended with status " + std::to_string(answered->status) : told) + hint(told), "Slurm");
}

Result<std::uint64_t> Slurm::submit(const SlurmArray& array, const SlurmWishes& wishes) const {
    std::vector<std::string> words{"sbatch", "--parsable", "--requeue", "--open-mode=append", "--export=ALL", "--chdir=/", "--nodes=1", "--ntasks=1"};
    const auto add = [&](const char* option, const std::string& value) {
        if (!value.empty()) words.push_back(std::string(option) + "=" + value);
    };
    const auto add_number = [&](const char* option, std::size_t value, const char* unit = "") {
        if (value > 0) words.push_back(std::string(option) + "=" + std::to_string(value) + unit);
    };
    add("--job-name", array.name);
    add("--comment", on_one_line(array.person));
    add("--array", ranges_text(array.places));
    add("--output", array.log.string());
    add("--partition", wishes.partition);
    add("--account", wishes.account);
    add("--qos", wishes.qos);
    add("--gres", wishes.gres);
    add_number("--cpus-per-task", wishes.cpus);
    add_number("--mem", wishes.memory_mib, "M");
    add_number("--time", wishes.minutes);
    std::string avoided;
    for (const std::string& node : array.avoided) avoided += (avoided.empty() ? "" : ",") + node;
    add("--exclude", avoided);
    words.push_back(array.script.string());
    words.insert(words.end(), array.command.begin(), array.command.end());
    WEAVE_TRY(const std::string answer, ask(words));
    const auto number = parse_submitted(answer);
    if (!number) return system_fault("sbatch tells no number: " + last_line(answer), "Slurm");
    return *number;
}

Result<std::vector<QueuedJob>> Slurm::queue() const {
    WEAVE_TRY(const std::string answer, ask({"squeue", "--me", "--array", "--noheader", "--states=all", "--format=%F|%K|%j|%T|%N|%r"}));
    return parse_queue(answer);
}

Status Slurm::cancel(const std::vector<std::string>& ids) const {
    if (ids.empty()) return {};
    std::vector<std::string> words{"scancel"};
    words.insert(words.end(), ids.begin(), ids.end());
    const auto answer = ask(words);
    return answer ? Status() : Status(answer.error());
}

Status Slurm::release(const std::string& id) const {
    const auto answer = ask({"scontrol", "release", id});
    return answer ? Status() : Status(answer.error());
}

Status Slurm::start_now(const std::string& id) const {
    const auto answer = ask({"scontrol", "update", "JobId=" + id, "StartTime=now"});
    return answer ? Status() : Status(answer.error());
}

}  // namespace weave::simd
