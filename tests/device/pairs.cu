#include "pairs.hpp"
