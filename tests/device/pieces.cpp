#include "pieces.hpp"
