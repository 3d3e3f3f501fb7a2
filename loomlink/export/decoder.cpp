#include <weave/io/controller_file.hpp>

#include <loomlink/export/read_back.hpp>

namespace weave::loomlink {

namespace {

LiftTable table_of(const HookLifts& lifts) {
    LiftTable table(lifts.picks(), lifts.hooks());
    for (std::size_t pick = 0; pick < lifts.picks(); ++pick) {
        for (std::size_t hook = 0; hook < lifts.hooks(); ++hook) {
            if (lifts.lifted(pick, hook)) table.lift(pick, hook);
        }
    }
    return table;
}

/// Without an encoding the file says nothing of feeders.
std::vector<std::vector<std::size_t>> feeders_of(const ControllerCard& read) {
    std::vector<std::vector<std::size_t>> feeders(read.card.picks());
    for (std::size_t pick = 0; pick < read.feeders.size(); ++pick)
        feeders[pick].assign(read.feeders[pick].begin(), read.feeders[pick].end());
    return feeders;
}

}  // namespace

Result<DecodedFile> decode_controller_file(std::string_view bytes, const LoomProfile& profile,
                                           std::size_t ends) {
    WEAVE_TRY(ControllerFile file, read_controller_file(bytes, profile));
    WEAVE_TRY(ControllerCard read, weave::card_of(file, profile, ends));
    DecodedFile decoded;
    decoded.names = {file.name, file.comment};
    decoded.lifts = table_of(file.lifts);
    decoded.feeders = feeders_of(read);
    decoded.card = std::move(read.card);
    decoded.oddities = std::move(file.warnings);
    decoded.oddities.insert(decoded.oddities.end(), read.warnings.begin(), read.warnings.end());
    for (const HookDifference& difference : read.differences)
        decoded.oddities.push_back(in_words(difference));
    return decoded;
}

}  // namespace weave::loomlink
