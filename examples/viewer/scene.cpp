#include "scene.h"

#include <pcl/common/transforms.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <utility>

namespace pcl_floam::viewer {

namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 800;

pcl::PointXYZ pointAt(const Eigen::Vector3d& place)
{
  return {static_cast<float>(place.x()), static_cast<float>(place.y()), static_cast<float>(place.z())};
}

}  // namespace

Scene::Scene(bool off_screen, std::function<void(const std::string&)> keys)
    : off_screen_(off_screen), viewer_("pcl_floam", !off_screen)
{
  viewer_.getRenderWindow()->SetOffScreenRendering(off_screen ? 1 : 0);
  viewer_.setSize(kWidth, kHeight);
  viewer_.setShowFPS(false);
  viewer_.setBackgroundColor(0.07, 0.08, 0.10);
  if (!off_screen) {
    viewer_.getRenderWindow()->GetInteractor()->CreateRepeatingTimer(10);  // else PCL 1.13 waits there for the user
    viewer_.registerKeyboardCallback([keys = std::move(keys)](const pcl::visualization::KeyboardEvent& event) {
      if (event.keyDown()) {
        keys(event.getKeySym());
      }
    });
  }
}

void Scene::show(const Cloud::ConstPtr& cloud, const Look& look, const std::string& name)
{
  const pcl::visualization::PointCloudColorHandlerCustom<pcl::PointXYZ> colour(cloud, look.r, look.g, look.b);
  if (!viewer_.updatePointCloud<pcl::PointXYZ>(cloud, colour, name)) {
    viewer_.addPointCloud<pcl::PointXYZ>(cloud, colour, name);
    viewer_.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, look.size, name);
  }
}

void Scene::showMap(const OdometryResult& result)
{
  if (result.mapPlanes()) {
    show(result.mapPlanes(), {150.0, 155.0, 165.0, 1.0}, "map planes");
    show(result.mapEdges(), {190.0, 130.0, 60.0, 2.0}, "map edges");
  }
}

void Scene::showPath(const Trajectory& poses, std::size_t current)
{
  auto past = pcl::make_shared<Cloud>();
  auto future = pcl::make_shared<Cloud>();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    (i <= current ? past : future)->push_back(pointAt(poses[i].world_T_sensor.translation));
  }
  show(future, {60.0, 110.0, 70.0, 2.0}, "path to come");
  show(past, {60.0, 255.0, 90.0, 4.0}, "path");
}

void Scene::showScan(const SeenScan& scan, const SE3& world_T_sensor)
{
  const auto inWorld = [&](const Cloud::Ptr& cloud) {
    auto moved = pcl::make_shared<Cloud>();
    pcl::transformPointCloud(*cloud, *moved, world_T_sensor.matrix<float>());
    return moved;
  };
  show(inWorld(scan.points), {215.0, 215.0, 215.0, 1.0}, "scan");
  show(inWorld(scan.planes), {70.0, 150.0, 255.0, 4.0}, "planes");
  show(inWorld(scan.edges), {255.0, 70.0, 60.0, 5.0}, "edges");
}

void Scene::showText(const std::string& text)
{
  constexpr int kMargin = 12;
  constexpr int kFont = 16;
  if (!viewer_.updateText(text, kMargin, kMargin, kFont, 1.0, 1.0, 1.0, "text")) {
    viewer_.addText(text, kMargin, kMargin, kFont, 1.0, 1.0, 1.0, "text");
  }
}

void Scene::follow(const SE3& world_T_sensor)
{
  const Eigen::Vector3d& at = world_T_sensor.translation;
  const Eigen::Vector3d from = at - 15.0 * world_T_sensor.rotation.col(0) + Eigen::Vector3d(0.0, 0.0, 25.0);
  viewer_.setCameraPosition(from.x(), from.y(), from.z(), at.x(), at.y(), at.z(), 0.0, 0.0, 1.0);
}

void Scene::overlook(const Trajectory& poses)
{
  Eigen::Vector3d lowest = poses.front().world_T_sensor.translation;
  Eigen::Vector3d highest = lowest;
  for (const StampedPose& pose : poses) {
    lowest = lowest.cwiseMin(pose.world_T_sensor.translation);
    highest = highest.cwiseMax(pose.world_T_sensor.translation);
  }
  constexpr double kSurroundings = 15.0;  // m
  const Eigen::Vector3d middle = 0.5 * (lowest + highest);
  const double away = kSurroundings + 0.9 * (highest - lowest).norm();
  const Eigen::Vector3d from = middle + away * Eigen::Vector3d(-0.45, -0.55, 0.9);
  viewer_.setCameraPosition(from.x(), from.y(), from.z(), middle.x(), middle.y(), middle.z(), 0.0, 0.0, 1.0);
}

void Scene::save(const std::string& picture)
{
  const vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(viewer_.getRenderWindow());
  const vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(image->GetOutputPort());
  writer->SetFileName(picture.c_str());
  writer->Write();
}

bool Scene::draw()
{
  constexpr int kMilliseconds = 10;
  if (off_screen_) {  // nobody to wait for: there is no interactor
    viewer_.getRenderWindow()->Render();
    return false;
  }
  viewer_.spinOnce(kMilliseconds, true);
  return !viewer_.wasStopped();
}

}  // namespace pcl_floam::viewer
