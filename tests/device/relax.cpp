#include "relax.hpp"
