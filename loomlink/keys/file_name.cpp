#include <loomlink/keys/file_name.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <cctype>

namespace weave::loomlink {

namespace {

constexpr std::size_t longest = 100;

Error refused(std::string_view name, const std::string& why) {
    return bad_input("the file name '" + on_one_line(name.substr(0, longest)) + "' " + why);
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-' || c == '_';
}

}  // namespace

std::string folded_name(std::string_view name) {
    std::string folded(name);
    for (char& c : folded) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return folded;
}

bool is_device_name(std::string_view name) {
    const std::string folded = folded_name(name);
    constexpr std::array<std::string_view, 4> devices{"con", "prn", "aux", "nul"};
    if (std::find(devices.begin(), devices.end(), folded) != devices.end()) return true;
    return folded.size() == 4 && (folded.starts_with("com") || folded.starts_with("lpt")) &&
           folded[3] >= '0' && folded[3] <= '9';
}

Status check_file_name(std::string_view name) {
    if (name.empty()) return refused(name, "is empty");
    if (name.size() > longest)
        return refused(name, "has more than " + std::to_string(longest) + " characters");
    if (name.find_first_of("/\\") != std::string_view::npos)
        return refused(name, "leads into a folder; files of a release lie side by side");
    if (!std::all_of(name.begin(), name.end(), is_plain))
        return refused(name, "may have letters, digits, points, hyphens and underscores alone");
    if (name.front() == '.' || name.front() == '-')
        return refused(name, "may not start with a point or a hyphen");
    if (name.back() == '.') return refused(name, "may not end with a point");
    if (is_device_name(name.substr(0, name.find('.'))))
        return refused(name, "is the name of a device on Windows");
    return {};
}

}  // namespace weave::loomlink
