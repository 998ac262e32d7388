#ifndef CLOCK_GLSL
#define CLOCK_GLSL

// Time without lost digits: a value and its rest (Dekker 1971). `precise` keeps compilers from contracting.
struct Exact {
  float value, rest;
};

Exact exactSum(float a, float b) {
  precise float sum = a + b;
  precise float part = sum - a;
  precise float rest = (a - (sum - part)) + (b - part);
  return Exact(sum, rest);
}

// a * b by halves of 12 bits; |a|, |b| below 1e34.
Exact exactProduct(float a, float b) {
  precise float wideA = 4097.0 * a, wideB = 4097.0 * b;
  precise float a1 = wideA - (wideA - a), b1 = wideB - (wideB - b);
  precise float a2 = a - a1, b2 = b - b1;
  precise float product = a * b;
  precise float rest = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
  return Exact(product, rest);
}

Exact elapsedSince(float start, float startRest, float now, float nowRest) {
  Exact whole = exactSum(now, -start);
  precise float rest = whole.rest + (nowRest - startRest);
  return exactSum(whole.value, rest);
}

// What is left of `elapsed` after whole rounds of `duration`, which are counted.
float withinRound(Exact elapsed, float duration, out float rounds) {
  rounds = floor(elapsed.value / duration);
  Exact done = exactProduct(rounds, duration);
  precise float left = (elapsed.value - done.value) + (elapsed.rest - done.rest);
  // The quotient may round past a whole number.
  if (left < 0.0) { left += duration; rounds -= 1.0; }
  if (left >= duration) { left -= duration; rounds += 1.0; }
  return left;
}

#endif
