/* The layouts of records, as a host in C99 has them. */
#include "skitter/records.h"

int legRecordInC(int agent, int leg, int legs) { return legRecord(agent, leg, legs); }
float tileXInC(float tile) { return tileX(tile); }
float tileZInC(float tile) { return tileZ(tile); }
float ticksInC(float packed) { return ticksOf(packed); }
float tileOfTicksInC(float packed) { return tileOfTicks(packed); }
float tilesApartInC(float step, float body) { return tilesApart(step, body); }
int stridesInC(int bones) {
  return BODY_STRIDE + 100 * chainStride(bones) + 10000 * poseStride(8, bones, 0) + 1000000 * FOOTFALL_STRIDE;
}
