// The two formats of an HDL-64's calibration, each by a library that the build may lack.

#include "io/text.h"
#include "io/velodyne/laser_table.h"

#include <pcl_floam/io/scan_source.h>

#ifdef PCL_FLOAM_WITH_XML
#include <tinyxml2.h>
#endif
#ifdef PCL_FLOAM_WITH_YAML
#include <yaml-cpp/yaml.h>
#endif

namespace pcl_floam {

namespace {

#if !defined(PCL_FLOAM_WITH_XML) || !defined(PCL_FLOAM_WITH_YAML)
[[noreturn]] void refuseLaserFile(const std::filesystem::path& file, const char* format, const char* package)
{
  throw FileError(file, std::string("is a calibration in ") + format + ", which this build left out: install " +
                            package + " and configure pcl_floam again");
}
#endif

#if defined(PCL_FLOAM_WITH_XML) || defined(PCL_FLOAM_WITH_YAML)
std::string ofLaser(const std::string& name, const std::string& laser)
{
  return name + " of laser " + laser.substr(0, 40);
}
#endif

}  // namespace

double laserNumber(const std::filesystem::path& file, std::string_view text, const std::string& what)
{
  const std::vector<std::string_view> words = splitWords(text);
  const auto number = words.size() == 1 ? parseNumber<double>(words.front()) : std::nullopt;
  if (!number) {
    throw FileError(file, what + ": '" + std::string(text.substr(0, 40)) + "' is no number");
  }
  return *number;
}

#ifndef PCL_FLOAM_WITH_XML

LaserTable lasersOfXml(const std::filesystem::path& file, const std::string&)
{
  refuseLaserFile(file, "XML", "libtinyxml2-dev");
}

#else

namespace {

std::string textOf(const tinyxml2::XMLElement* parent, const char* name)
{
  const tinyxml2::XMLElement* element = parent == nullptr ? nullptr : parent->FirstChildElement(name);
  return element == nullptr || element->GetText() == nullptr ? "" : element->GetText();
}

LaserNumbers laserOfXml(const std::filesystem::path& file, const tinyxml2::XMLElement& item)
{
  LaserNumbers numbers;
  const std::string place = "line " + std::to_string(item.GetLineNum()) + ": ";
  const std::string id = textOf(&item, "id_");
  numbers["laser_id"] = laserNumber(file, id, place + "id_ of a laser");
  for (const LaserNumber& number : kLaserNumbers) {
    const std::string text = textOf(&item, number.xml);
    if (!text.empty() || number.is_required) {
      numbers[number.yaml] = number.factor * laserNumber(file, text, place + ofLaser(number.xml, id));
    }
  }
  return numbers;
}

}  // namespace

LaserTable lasersOfXml(const std::filesystem::path& file, const std::string& content)
{
  tinyxml2::XMLDocument document;
  if (document.Parse(content.data(), content.size()) != tinyxml2::XML_SUCCESS) {
    throw FileError(file, "line " + std::to_string(document.ErrorLineNum()) + ": is no XML: " + document.ErrorName());
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  const tinyxml2::XMLElement* db = root == nullptr ? nullptr : root->FirstChildElement("DB");
  const tinyxml2::XMLElement* points = db == nullptr ? nullptr : db->FirstChildElement("points_");
  if (points == nullptr) {
    throw FileError(file, "has no lasers (DB, points_): a Velodyne's db.xml is asked for");
  }
  LaserTable table;
  for (const auto* item = points->FirstChildElement("item"); item != nullptr; item = item->NextSiblingElement("item")) {
    if (const tinyxml2::XMLElement* px = item->FirstChildElement("px")) {
      table.lasers.push_back(laserOfXml(file, *px));
    }
  }
  const std::string unit = textOf(db, "distLSB_");
  if (!unit.empty()) {
    table.distance_unit = kMetresPerCentimetre * laserNumber(file, unit, "distLSB_");
  }
  return table;
}

#endif

#ifndef PCL_FLOAM_WITH_YAML

LaserTable lasersOfYaml(const std::filesystem::path& file, const std::string&)
{
  refuseLaserFile(file, "YAML", "libyaml-cpp-dev");
}

#else

namespace {

std::string scalarOf(const YAML::Node& laser, const char* name)
{
  const YAML::Node value = laser[name];
  return value.IsDefined() && value.IsScalar() ? value.Scalar() : "";
}

LaserNumbers laserOfYaml(const std::filesystem::path& file, const YAML::Node& laser)
{
  const std::string place = "line " + std::to_string(laser.Mark().line + 1) + ": ";
  if (!laser.IsMap()) {
    throw FileError(file, place + "the entry of lasers is no laser: names with their numbers are asked for");
  }
  LaserNumbers numbers;
  const std::string id = scalarOf(laser, "laser_id");
  numbers["laser_id"] = laserNumber(file, id, place + "laser_id of a laser");
  for (const LaserNumber& number : kLaserNumbers) {
    const std::string text = scalarOf(laser, number.yaml);
    if (!text.empty() || number.is_required) {
      numbers[number.yaml] = laserNumber(file, text, place + ofLaser(number.yaml, id));
    }
  }
  if (scalarOf(laser, "two_pt_correction_available") == "false") {
    numbers.erase("dist_correction_x");
    numbers.erase("dist_correction_y");
  }
  return numbers;
}

}  // namespace

LaserTable lasersOfYaml(const std::filesystem::path& file, const std::string& content)
{
  try {
    const YAML::Node root = YAML::Load(content);
    const YAML::Node lasers = root.IsMap() ? root["lasers"] : YAML::Node();
    if (!lasers.IsDefined() || !lasers.IsSequence()) {
      throw FileError(file,
                      "has no list of lasers: a calibration of the ROS driver (velodyne_pointcloud) is asked for");
    }
    LaserTable table;
    for (const YAML::Node& laser : lasers) {
      table.lasers.push_back(laserOfYaml(file, laser));
    }
    const std::string unit = scalarOf(root, "distance_resolution");
    if (!unit.empty()) {
      table.distance_unit = laserNumber(file, unit, "distance_resolution");
    }
    return table;
  } catch (const YAML::Exception& error) {
    throw FileError(file, "line " + std::to_string(error.mark.line + 1) + ": is no YAML: " + error.msg);
  }
}

#endif

}  // namespace pcl_floam
