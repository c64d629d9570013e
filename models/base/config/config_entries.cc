#include "models/base/config/config_entries.h"

#include <cmath>

#include "models/base/error.h"
#include "models/base/text.h"

namespace tubetwin::config_internal {
namespace {

class Describer : public ConfigVisitor {
 public:
  explicit Describer(Entry& into) : into_(into) {}
  void Field(const char* key, const char* doc, bool& value) override {
    Add(key, doc, Entry::Type::kBool).value = value;
  }
  void Field(const char* key, const char* doc, std::int64_t& value, Range allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kInteger);
    entry.value = value;
    entry.allowed = allowed;
  }
  void Field(const char* key, const char* doc, double& value, Range allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kNumber);
    entry.value = value;
    entry.allowed = allowed;
  }
  void Field(const char* key, const char* doc, std::string& value) override {
    Add(key, doc, Entry::Type::kText).value = value;
  }
  void Choice(const char* key, const char* doc, std::string& value,
              const std::vector<std::string>& allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kChoice);
    entry.value = value;
    entry.choices = allowed;
  }
  void Field(const char* key, const char* doc, std::vector<double>& value, int count,
             Range allowed) override {
    Entry& entry = Add(key, doc, Entry::Type::kNumbers);
    entry.value = value;
    entry.count = count;
    entry.allowed = allowed;
  }
  void Field(const char* key, const char* doc, std::vector<std::string>& value) override {
    Add(key, doc, Entry::Type::kTexts).value = value;
  }
  void Section(const char* key, const char* doc,
               const std::function<void(ConfigVisitor&)>& visit) override {
    Entry* section = nullptr;
    for (Entry& child : into_.children) {
      if (child.key == key && child.type == Entry::Type::kSection) section = &child;
    }
    if (section == nullptr) section = &Add(key, doc, Entry::Type::kSection);
    Describer inner(*section);
    visit(inner);
  }

 private:
  Entry& Add(const char* key, const char* doc, Entry::Type type) {
    for (const Entry& child : into_.children) TT_CHECK(child.key != key);  // One key, one meaning.
    Entry& entry = into_.children.emplace_back();
    entry.key = key;
    entry.doc = doc;
    entry.type = type;
    return entry;
  }
  Entry& into_;
};

}  // namespace

Entry DescribeFields(const std::function<void(ConfigVisitor&)>& visit) {
  Entry root;
  Describer describer(root);
  visit(describer);
  return root;
}

std::string AllowedText(Range allowed) {
  if (std::isinf(allowed.low)) return "at most " + Number(allowed.high);
  if (std::isinf(allowed.high)) return "at least " + Number(allowed.low);
  return Number(allowed.low) + " to " + Number(allowed.high);
}

}  // namespace tubetwin::config_internal
