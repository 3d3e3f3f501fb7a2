#include "curvature.hpp"
