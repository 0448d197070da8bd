#include "host/cost/drawing.h"
#include "host/loaded_library.h"

namespace wale::cost {

const DrawingPainter& drawing_painter() {
  static const auto* painter = static_cast<const DrawingPainter*>(load_table(kPainterLibrary, kPainterFunction));
  return *painter;
}

}  // namespace wale::cost
