#include "host/price_class.h"

namespace wale {

PriceClass price_class(const std::string&, const std::string&) { return {"not measured", 0, ""}; }

}  // namespace wale
