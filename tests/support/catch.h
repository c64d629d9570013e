#pragma once

// Debian's Catch2 2.13 single header; only this file and catch_main.cc know its path.
#include <catch2/catch.hpp>
