#include "sweep.hpp"

#include "simulate_wish.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace weave::program {

namespace {

/// `friction=0.1` for each value of `friction=0,0.1`.
Result<std::vector<std::string>> settings_of(const std::string& word) {
    const Error trouble = usage_error("write it as NAME=N,N,… with different numbers, such as friction=0,0.1,0.2", "--sweep " + word);
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos || sign == 0) return trouble;
    const std::string name = word.substr(0, sign);
    std::vector<std::string> settings;
    std::set<std::string> values;
    for (std::size_t begin = sign + 1; begin <= word.size();) {
        const std::size_t end = std::min(word.find(',', begin), word.size());
        std::string value = word.substr(begin, end - begin);
        if (value.empty() || !values.insert(value).second) return trouble;
        settings.push_back(name + "=" + value);
        begin = end + 1;
    }
    if (settings.empty()) return trouble;
    return settings;
}

}  // namespace

Result<std::vector<std::vector<std::string>>> runs_of_sweep(const std::vector<std::string>& words) {
    std::vector<std::vector<std::string>> runs{{}};
    std::set<std::string> names;
    for (const std::string& word : words) {
        WEAVE_TRY(const std::vector<std::string> settings, settings_of(word));
        if (!names.insert(word.substr(0, word.find('='))).second) return usage_error("was given before: write all of its numbers behind one", "--sweep " + word);
        if (runs.size() * settings.size() > most_runs) return usage_error("makes more than " + std::to_string(most_runs) + " runs in all", "--sweep " + word);
        std::vector<std::vector<std::string>> longer;
        for (const auto& run : runs) {
            for (const std::string& setting : settings) {
                longer.push_back(run);
                longer.back().push_back(setting);
            }
        }
        runs = std::move(longer);
    }
    return runs;
}

}  // namespace weave::program
