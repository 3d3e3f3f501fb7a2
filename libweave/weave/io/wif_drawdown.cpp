#include <weave/io/wif_drawdown.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace weave::wif {

namespace {

constexpr std::size_t most_shafts_of_end = 64;
/// Steps, of one end or of eight bytes of a row, after which a file is refused: seconds of work.
constexpr std::uint64_t most_work = std::uint64_t{1} << 33;
constexpr std::size_t most_treadle_bytes = std::size_t{1} << 29;

struct Listed {
    bool any = false;
    std::size_t low = 0, high = 0;
};

/// The lowest and highest number in a section, without judging its lines.
Listed listed_in(const Section* section) {
    Listed listed;
    if (section == nullptr) return listed;
    for (const Entry& entry : section->entries) {
        const std::optional<std::int64_t> key = parse_whole(entry.key);
        if (!key || *key < 0 || *key > static_cast<std::int64_t>(most_threads)) continue;
        const auto number = static_cast<std::size_t>(*key);
        listed.low = listed.any ? std::min(listed.low, number) : number;
        listed.high = std::max(listed.high, number);
        listed.any = true;
    }
    return listed;
}

/// Whether a list counts its threads from 0: it says so itself, or the main list does and this one fits.
bool from_zero(const Listed& listed, const Threads& threads) {
    return (listed.any && listed.low == 0) || (threads.from_zero && listed.high < threads.count);
}

/// More threads are declared than listed. An unlisted shaft or treadle is 0, so the last lines may be missing
/// because nothing lifts there; or the declaration is overstated, as some programs do by far. So: up to a
/// quarter is the first, more is the second.
void keep_or_drop(Threads& threads, std::size_t declared, std::size_t line, const std::string& section,
                  const std::string& noun, Warnings& warnings) {
    const std::size_t listed = threads.count, missing = declared - listed;
    const std::string which =
        missing == 1 ? noun + " " + std::to_string(declared)
                     : noun + "s " + std::to_string(listed + 1) + " to " + std::to_string(declared);
    const bool keep = missing <= declared / 4;
    warnings.add(line, section + " says " + counted(declared, noun) + ", but only " + std::to_string(listed) +
                           " are listed; " + which +
                           (keep ? (missing == 1 ? " is" : " are") +
                                       std::string(" read as lifting nothing, as unlisted threads do")
                                 : (missing == 1 ? " is" : " are") +
                                       std::string(" dropped, as more than a quarter is missing")));
    if (keep) threads.count = declared;
}

Result<Threads> threads_of(const File& file, const std::string& system, const std::string& main_list,
                           Warnings& warnings) {
    const std::string noun = system == "warp" ? "end" : "pick";
    const Listed main = listed_in(file.find(main_list));
    Threads threads{0, main.any && main.low == 0, 0};
    const auto note = [&](const Listed& listed) {
        if (listed.any) threads.count = std::max(threads.count, listed.high + (listed.low == 0 ? 1 : 0));
    };
    note(main);
    for (const char* list : {" colors", " thickness", " spacing"}) note(listed_in(file.find(system + list)));
    if (threads.from_zero)
        warnings.add(file.find(main_list)->line, shown(main_list) + " counts from 0; read as from 1");
    const Section* section = file.find(system);
    const Entry* declared = section == nullptr ? nullptr : section->find("threads");
    if (threads.count == 0) {
        return bad_input("gives no " + noun + "s in " + shown(main_list),
                         place(declared != nullptr  ? declared->line
                               : section != nullptr ? section->line
                                                    : 1));
    }
    threads.listed = threads.count;
    if (declared == nullptr) {
        warnings.add(shown(system) + " does not say Threads; " + counted(threads.count, noun) +
                     " are listed");
        return threads;
    }
    WEAVE_TRY(const std::int64_t said, whole(*declared, 1, most_threads));
    const auto count = static_cast<std::size_t>(said);
    if (count > threads.count) {
        keep_or_drop(threads, count, declared->line, shown(system), noun, warnings);
    } else {
        threads.count = count;  // where more are listed per_thread() finds the line to name
    }
    return threads;
}

/// A set of ends: a list while that is short, packed bits (1 = in the set) once it is not.
struct EndSet {
    std::vector<std::uint32_t> ends;
    std::vector<std::uint8_t> bits;

    [[nodiscard]] bool is_empty() const { return ends.empty() && bits.empty(); }
    [[nodiscard]] std::uint64_t work() const { return ends.size() + bits.size() / 8 + 1; }
    void add_to(std::span<std::uint8_t> row) const {
        for (const std::uint32_t end : ends) row[end / 8] |= static_cast<std::uint8_t>(0x80 >> end % 8);
        for (std::size_t k = 0; k < bits.size(); ++k) row[k] |= bits[k];
    }
};

/// The list as bits where it is longer than a row of words: then OR-ing words is quicker and never larger.
void pack(EndSet& set, std::size_t row_bytes) {
    if (set.ends.size() <= row_bytes / 8) return;
    std::vector<std::uint8_t> bits(row_bytes);
    set.add_to(bits);
    set = {{}, std::move(bits)};
}

void sort_out(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    if (!numbers.empty() && numbers.front() == 0) numbers.erase(numbers.begin());  // 0: none
}

/// Adds up work and refuses when it is too much.
class Budget {
  public:
    Status spend(std::uint64_t work, std::size_t line) {
        m_spent += work;
        if (m_spent <= most_work) return {};
        return bad_input(
            "lifts so many shafts with so many ends that the file cannot be read in reasonable time",
            place(line));
    }

  private:
    std::uint64_t m_spent = 0;
};

/// Shafts=, or Treadles=, of [WEAVING].
Result<std::uint32_t> declared_count(const File& file, const std::string& key) {
    const Section* weaving = file.find("weaving");
    if (weaving == nullptr)
        return bad_input("has no [WEAVING], which says how many shafts there are", place(1));
    const Entry* entry = weaving->find(key);
    if (entry == nullptr)
        return bad_input("[WEAVING] does not say how many " + key + " there are", place(weaving->line));
    WEAVE_TRY(const std::int64_t count, whole(*entry, 1, most_shafts));
    return static_cast<std::uint32_t>(count);
}

/// Threads, from 0 and rising, as people say them: `end 4`, `ends 2, 5 to 7 and 9 more`.
std::string said(const std::string& noun, const std::vector<std::size_t>& threads) {
    constexpr std::size_t most_ranges = 6;
    std::string text;
    std::size_t at = 0;
    for (std::size_t ranges = 0; at < threads.size() && ranges < most_ranges; ++ranges) {
        const std::size_t first = at++;
        while (at < threads.size() && threads[at] == threads[at - 1] + 1) ++at;
        text += (ranges == 0 ? "" : ", ") + std::to_string(threads[first] + 1);
        if (at - first > 1) text += " to " + std::to_string(threads[at - 1] + 1);
    }
    if (at < threads.size()) text += " and " + std::to_string(threads.size() - at) + " more";
    return noun + (threads.size() == 1 ? " " : "s ") + text;
}

using Lines = std::vector<std::pair<std::size_t, Entry>>;

/// The standard lets a file leave out what lifts nothing. That is seldom meant, though.
void warn_of_left_out(const Section& section, const Lines& lines, const Threads& threads, const std::string& noun,
                      const std::string& read_as, Warnings& warnings) {
    std::vector<bool> is_there(threads.count);
    for (const auto& [number, entry] : lines) is_there[number] = true;
    std::vector<std::size_t> left_out;
    for (std::size_t number = 0; number < std::min(threads.count, threads.listed); ++number) {
        if (!is_there[number]) left_out.push_back(number);
    }
    if (left_out.empty()) return;
    warnings.add(section.line, shown(section.name) + " leaves out " + said(noun, left_out) + ", read as " + read_as);
}

/// For each shaft, from 1, the ends on it.
Result<std::vector<EndSet>> read_threading(const File& file, const Threads& ends, std::uint32_t shafts,
                                           Warnings& warnings) {
    const Section& threading = *file.find("threading");
    WEAVE_TRY(const auto lines, per_thread(threading, ends, warnings));
    warn_of_left_out(threading, lines, ends, "end", "on no shaft", warnings);
    std::vector<std::size_t> on_none;
    std::vector<EndSet> on_shaft(std::size_t{shafts} + 1);
    for (const auto& [end, entry] : lines) {
        WEAVE_TRY(auto numbers, whole_list(entry.value, entry.line, shafts));
        sort_out(numbers);
        if (numbers.empty()) on_none.push_back(end);
        if (numbers.size() > most_shafts_of_end)
            return bad_input("puts an end on more than " + counted(most_shafts_of_end, "shaft"),
                             place(entry.line));
        for (const std::uint32_t shaft : numbers)
            on_shaft[shaft].ends.push_back(static_cast<std::uint32_t>(end));
    }
    if (!on_none.empty())
        warnings.add(threading.line, "[THREADING] puts " + said("end", on_none) + " on no shaft (0)");
    for (EndSet& set : on_shaft) pack(set, (ends.count + 7) / 8);
    return on_shaft;
}

/// What the drawdown has of [TIEUP]: for each treadle, from 1, the ends on the shafts that are tied to it.
struct TieUp {
    std::vector<EndSet> on_treadle;
    std::vector<bool> is_listed;
};

Result<TieUp> read_tie_up(const File& file, std::uint32_t treadles, const std::vector<EndSet>& on_shaft,
                          std::size_t row_bytes, Budget& budget, Warnings& warnings) {
    WEAVE_TRY(const auto lines, per_thread(*file.find("tieup"), {treadles, false, treadles}, warnings));
    TieUp tie_up{std::vector<EndSet>(std::size_t{treadles} + 1), std::vector<bool>(std::size_t{treadles} + 1)};
    std::size_t bytes = 0;
    for (const auto& [treadle, entry] : lines) {
        tie_up.is_listed[treadle + 1] = true;
        WEAVE_TRY(auto shafts,
                  whole_list(entry.value, entry.line, static_cast<std::uint32_t>(on_shaft.size() - 1)));
        sort_out(shafts);
        if (shafts.empty()) continue;
        bytes += row_bytes;
        if (bytes > most_treadle_bytes)
            return bad_input("ties up more treadles than so wide a cloth allows", place(entry.line));
        std::vector<std::uint8_t> bits(row_bytes);
        for (const std::uint32_t shaft : shafts) {
            WEAVE_CHECK_OK(budget.spend(on_shaft[shaft].work(), entry.line));
            on_shaft[shaft].add_to(bits);
        }
        tie_up.on_treadle[treadle + 1].bits = std::move(bits);
    }
    return tie_up;
}

/// A warning names the treadles that picks press but [TIEUP] leaves out.
Status warn_of_untied(const Section& tie_up, const Lines& picks, const std::vector<bool>& is_listed,
                      Warnings& warnings) {
    std::vector<bool> untied(is_listed.size());
    for (const auto& [pick, entry] : picks) {
        WEAVE_TRY(const auto treadles,
                  whole_list(entry.value, entry.line, static_cast<std::uint32_t>(is_listed.size() - 1)));
        for (const std::uint32_t treadle : treadles) untied[treadle] = treadle > 0 && !is_listed[treadle];
    }
    std::vector<std::size_t> left_out;
    for (std::size_t treadle = 1; treadle < untied.size(); ++treadle) {
        if (untied[treadle]) left_out.push_back(treadle - 1);
    }
    if (!left_out.empty())
        warnings.add(tie_up.line, "[TIEUP] leaves out " + said("treadle", left_out) + ", read as lifting nothing");
    return {};
}

Result<bool> is_rising(const File& file, Warnings& warnings) {
    const Section* weaving = file.find("weaving");
    const Entry* entry = weaving == nullptr ? nullptr : weaving->find("rising shed");
    if (entry != nullptr) return boolean(*entry);
    warnings.add(weaving == nullptr ? 1 : weaving->line,
                 "[WEAVING] does not say Rising Shed; read as a rising shed");
    return true;
}

}  // namespace

Result<Drive> drive_of(const File& file, Warnings& warnings) {
    const auto holds = [&](const char* name) {
        const Section* section = file.find(name);
        return section != nullptr && !section->entries.empty();
    };
    const bool treadled = holds("tieup") && holds("treadling");
    if (treadled && holds("liftplan")) {
        warnings.add(file.find("liftplan")->line,
                     "[LIFTPLAN] stands beside [TIEUP] and [TREADLING], which win; it is not read");
    }
    if (treadled) return Drive::treadles;
    if (holds("liftplan")) return Drive::lift_plan;
    for (const char* name : {"treadling", "tieup", "liftplan"}) {
        const Section* section = file.find(name);
        if (section == nullptr || holds(name)) continue;
        return bad_input(shown(name) + " is empty, so nothing says how it is woven", place(section->line));
    }
    if (holds("treadling"))
        return bad_input("[TREADLING] has no [TIEUP] that says what the treadles move",
                         place(file.find("treadling")->line));
    return bad_input("has neither [TIEUP] and [TREADLING] nor [LIFTPLAN], so nothing says how it is woven",
                     place(1));
}

Result<Threads> ends_of(const File& file, Warnings& warnings) {
    const Section* threading = file.find("threading");
    if (threading == nullptr)
        return bad_input("has no [THREADING], so nothing says which shaft an end is on", place(1));
    return threads_of(file, "warp", "threading", warnings);
}

Result<Threads> picks_of(const File& file, Drive drive, Warnings& warnings) {
    return threads_of(file, "weft", drive == Drive::treadles ? "treadling" : "liftplan", warnings);
}

Result<std::vector<std::pair<std::size_t, Entry>>> per_thread(const Section& section, const Threads& threads,
                                                              Warnings& warnings) {
    WEAVE_TRY(auto lines, numbered(section, warnings));
    const std::size_t first =
        from_zero(lines.empty() ? Listed{} : Listed{true, lines.front().first, lines.back().first}, threads)
            ? 0
            : 1;
    if (first == 0 && !threads.from_zero)
        warnings.add(lines.front().second.line, shown(section.name) + " counts from 0; read as from 1");
    for (auto& [number, entry] : lines) {
        number -= first;
        if (number < threads.count) continue;
        return bad_input(shown(section.name) + " gives number " + std::to_string(number + first) +
                             ", but there are only " + std::to_string(threads.count),
                         place(entry.line));
    }
    return lines;
}

Result<CardImage> drawdown(const File& file, Drive drive, const Threads& ends, const Threads& picks,
                           Warnings& warnings) {
    WEAVE_CHECK_OK(check_card_size(picks.count, ends.count));
    WEAVE_TRY(const std::uint32_t shafts, declared_count(file, "shafts"));
    WEAVE_TRY(const bool rising, is_rising(file, warnings));
    WEAVE_TRY(std::vector<EndSet> moved, read_threading(file, ends, shafts, warnings));
    const std::size_t row_bytes = (ends.count + 7) / 8;
    Budget budget;
    const Section& plan = *file.find(drive == Drive::treadles ? "treadling" : "liftplan");
    WEAVE_TRY(const auto lines, per_thread(plan, picks, warnings));
    warn_of_left_out(plan, lines, picks, "pick", "lifting nothing", warnings);
    if (drive == Drive::treadles) {
        WEAVE_TRY(const std::uint32_t treadles, declared_count(file, "treadles"));
        WEAVE_TRY(TieUp tie_up, read_tie_up(file, treadles, moved, row_bytes, budget, warnings));
        moved = std::move(tie_up.on_treadle);
        WEAVE_CHECK_OK(warn_of_untied(*file.find("tieup"), lines, tie_up.is_listed, warnings));
    }
    CardImage card(picks.count, ends.count);
    for (const auto& [pick, entry] : lines) {
        WEAVE_TRY(auto numbers,
                  whole_list(entry.value, entry.line, static_cast<std::uint32_t>(moved.size() - 1)));
        sort_out(numbers);
        for (const std::uint32_t number : numbers) {
            WEAVE_CHECK_OK(budget.spend(moved[number].work(), entry.line));
            moved[number].add_to(card.row(pick));
        }
    }
    if (!rising) return card;  // what sinks has the weft over it
    const auto padding = static_cast<std::uint8_t>(ends.count % 8 == 0 ? 0xff : 0xff << (8 - ends.count % 8));
    for (std::size_t pick = 0; pick < picks.count; ++pick) {
        for (std::uint8_t& byte : card.row(pick)) byte = static_cast<std::uint8_t>(~byte);
        card.row(pick).back() &= padding;
    }
    return card;
}

}  // namespace weave::wif
