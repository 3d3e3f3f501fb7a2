#include <algorithm>
#include <loomlink/export/controller_files.hpp>
#include <loomlink/export/file_parts.hpp>

namespace weave::loomlink {

bool is_printable(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

Result<FittedName> fit_name(const std::string& wish, const LoomProfile& profile) {
    if (wish.empty()) return invalid("the file for the loom needs a name of at least one character");
    if (!is_printable(wish))
        return invalid("the name in the file for the loom may have letters, digits and signs of ASCII only");
    const std::size_t room = profile.name_limit == 0 ? name_room : std::min(name_room, profile.name_limit);
    return FittedName{wish.substr(0, room), wish.size() > room};
}

}  // namespace weave::loomlink
