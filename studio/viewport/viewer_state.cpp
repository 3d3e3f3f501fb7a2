// How things are looked at in viewer_panel.hpp, to be kept and found again.
#include <studio/viewport/viewer_panel.hpp>

#include <QComboBox>
#include <QSignalBlocker>
#include <QSlider>
#include <QSpinBox>

#include <algorithm>
#include <string>

namespace weave::studio {

namespace {

constexpr std::string_view colour_words[colourings]{"yarn", "system", "strain", "contact", "moved"};
constexpr std::string_view cut_words[]{"none", "ends", "picks", "height"};  ///< in the order of the list

/// Empty where there is no such text.
std::string text_in(const Json& json, const char* name) {
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// A whole number brought into its range; `otherwise` where there is none.
int number_in(const Json& json, int least, int most, int otherwise) {
    if (!json.is_number_integer()) return otherwise;
    return static_cast<int>(std::clamp<std::int64_t>(json.get<std::int64_t>(), least, most));
}

}  // namespace

Json ViewerPanel::state() const {
    return {{"camera", m_viewport->camera().to_json()},
            {"mode", m_mode == Mode::planned ? "planned" : "relaxed"},
            {"colour", colour_words[static_cast<std::size_t>(m_colour)]},
            {"repeat", {m_along_ends->value(), m_along_picks->value()}},
            {"cut",
             {{"across", cut_words[m_clips->currentIndex()]},
              {"at", m_clip_at->value()},
              {"side", m_clip_side < 0 ? -1 : 1}}},
            {"locked", m_viewport->is_locked()}};
}

Status ViewerPanel::set_state(const Json& json) {
    if (!json.is_object()) return bad_input("a view is an object", "view");
    if (const auto found = json.find("camera"); found != json.end()) {
        Camera camera;
        if (Status read = camera.from_json(*found); !read) return std::move(read).error().under("camera");
        m_viewport->set_camera(camera);
    }
    if (const std::string mode = text_in(json, "mode"); !mode.empty())
        set_mode(mode == "relaxed" ? Mode::relaxed : Mode::planned);
    for (std::size_t k = 0; k < colourings; ++k) {
        if (text_in(json, "colour") == colour_words[k]) set_colour(static_cast<ColourBy>(k));
    }
    if (const auto found = json.find("repeat");
        found != json.end() && found->is_array() && found->size() == 2) {
        m_along_ends->setValue(number_in((*found)[0], 1, most_repeats, 1));
        m_along_picks->setValue(number_in((*found)[1], 1, most_repeats, 1));
    }
    if (const auto found = json.find("cut"); found != json.end() && found->is_object()) set_cut(*found);
    if (const auto found = json.find("locked"); found != json.end() && found->is_boolean())
        m_viewport->set_locked(found->get<bool>());
    return {};
}

void ViewerPanel::set_cut(const Json& cut) {
    const auto* const word = std::find(std::begin(cut_words), std::end(cut_words), text_in(cut, "across"));
    if (word == std::end(cut_words)) return;
    {
        const QSignalBlocker quiet(m_clips);  // chosen anew it would take the side that the viewer is on
        m_clips->setCurrentIndex(static_cast<int>(word - std::begin(cut_words)));
    }
    m_clip_at->setValue(
        number_in(cut.value("at", Json()), m_clip_at->minimum(), m_clip_at->maximum(), m_clip_at->value()));
    m_clip_side = cut.value("side", Json()) == -1 ? -1 : 1;
    apply_clip();
}

}  // namespace weave::studio
