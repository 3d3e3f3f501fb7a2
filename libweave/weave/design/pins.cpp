#include <weave/design/pins.hpp>

#include <string>

namespace weave {

Status check_pins(const Scene& scene, const Block& cloth) {
    for (std::size_t k = 0; k < scene.pins.size(); ++k) {
        const Pin& pin = scene.pins[k];
        const std::size_t count = pin.is_pick ? cloth.picks() : cloth.ends();
        if (pin.number < count) continue;
        return bad_input("is " + std::to_string(pin.number) + ", but the cloth's " + (pin.is_pick ? "picks" : "ends") +
                             " count from 0 to " + std::to_string(count - 1),
                         "scene.pins[" + std::to_string(k) + "].number");
    }
    return {};
}

}  // namespace weave
