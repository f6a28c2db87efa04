// The task of an invocation of moments.comp, decoded from the task word of interface.glsl.
struct Task {
  int members;
  int piece;
  bool root_at_start;
  bool root_at_end;
  bool root_before_start;  // square root at the start of the preceding piece
  bool root_after_end;     // square root at the end of the next piece
  bool has_split_line;
  int most_azimuths;
  real before;  // five slopes: start of the preceding piece, start, end, end of the next piece, last end of all
  real start;
  real end;
  real after;
  real last;
};

bool has_bit(uint word, uint bit) { return ((word >> bit) & 1u) == 1u; }

Task task_of(uint word) {
  Task task;
  task.members = int(word & ((1u << DOLP_TASK_MEMBERS_BITS) - 1u));
  task.piece = int((word >> DOLP_TASK_PIECE_SHIFT) & ((1u << DOLP_TASK_PIECE_BITS) - 1u));
  task.root_at_start = has_bit(word, DOLP_TASK_ROOT_AT_START);
  task.root_at_end = has_bit(word, DOLP_TASK_ROOT_AT_END);
  task.root_before_start = has_bit(word, DOLP_TASK_ROOT_BEFORE_START);
  task.root_after_end = has_bit(word, DOLP_TASK_ROOT_AFTER_END);
  task.has_split_line = has_bit(word, DOLP_TASK_SPLIT_LINE);
  task.most_azimuths = int(word >> DOLP_TASK_AZIMUTHS_SHIFT);
  return task;
}

// moments.comp reads the slopes one by one instead: a copy of all slopes costs a driver half a second of compilation.
Task with_slopes(Task task, ThetaNode theta) {
  task.before = theta.end[max(task.piece - 1, 0)];
  task.start = theta.end[task.piece];
  task.end = theta.end[min(task.piece + 1, DOLP_MAX_PIECES)];
  task.after = theta.end[min(task.piece + 2, DOLP_MAX_PIECES)];
  task.last = theta.end[DOLP_MAX_PIECES];
  return task;
}

// A piece [a, b] of the slope axis. X = asinh(t/scale) is linear in y, from 0 to 1. The map y(v) from the abscissa v of
// a rule removes square roots: y = v^2 for a root at a, 1 - (1-v)^2 at b, v^2 (3 - 2v) at both ends.
struct Piece {
  real start;   // X at a
  real extent;  // in X
  bool root_at_a;
  bool root_at_b;
  real root_before;       // X of a square root at the start of the preceding piece, unless it is near a; else X at a
  real root_after;        // X of a square root at the end of the next piece, unless it is near b; else X at b
  real mass[DOLP_WIDTH];  // share of the facets on the piece, for each entry of a row
  real fall;              // logarithm of the share of facets steeper than a divided by the share steeper than b
  real digits;            // digits that the most demanding entry of a row requires
  int order;
};
