#pragma once

#include <span>
#include <string>
#include <vector>

#include "skitter/model.h"

namespace skitter {

// The words of a joint's name in lower case: "Leg4IK.L" is leg, 4, ik, l.
std::vector<std::string> wordsOf(const std::string& name);
std::vector<std::string> wordsOf(const Model& model, const std::vector<int>& nodes);

// A word ending in * also names all longer words that begin like it: head* has headtop.
using Words = std::span<const char* const>;
bool hasWord(const std::vector<std::string>& words, Words wanted);

// 1 for names of the left, -1 for the right, 0 for neither or both.
int sideOf(const std::vector<std::string>& words);

// What joints are called that are no legs.
extern const Words armWords, fingerWords, heldWords, looseWords;
// Joints that steer others or only turn skin with them.
extern const Words helperWords;

}  // namespace skitter
