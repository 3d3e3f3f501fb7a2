#pragma once

#include <weave/core/json.hpp>

namespace weave::bench {

/// Which part of the points of the structures of the paper's Table 1, and of the I-beam, needs no step any
/// more, during a relaxation from the planned start and during the one that follows a flip: what leaving
/// settled regions out could save at most. One thread; of each run at most 600 steps.
Json settling();

}  // namespace weave::bench
