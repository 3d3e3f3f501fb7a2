#include <loomlink/workflow/denial.hpp>

#include <algorithm>
#include <array>

namespace weave::loomlink {

namespace {

constexpr std::array denial_words{"who", "password", "rights", "absent", "conflict", "often"};

}  // namespace

const char* word(Denial denial) {
    return denial_words[static_cast<std::size_t>(denial)];
}

Error deny(Denial denial, std::string message) {
    return {ErrorCode::refused, std::move(message), word(denial)};
}

std::optional<Denial> denial_of(const Error& error) {
    if (error.code != ErrorCode::refused) return {};
    const auto place = std::find(denial_words.begin(), denial_words.end(), error.where);
    return place == denial_words.end() ? Denial::conflict : static_cast<Denial>(place - denial_words.begin());
}

}  // namespace weave::loomlink
