#include "lists.hpp"
