#include "forces.hpp"
