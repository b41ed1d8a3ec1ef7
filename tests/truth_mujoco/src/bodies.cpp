#include "bodies.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace mujoco_truth {
namespace {

/// Inertia of a point mass: MuJoCo requires a value above zero.
constexpr const char* kPoint = "1e-9 1e-9 1e-9";
/// Mass of the rotor of a motor: its inertia is the armature of the joint, which does not move with the jib.
constexpr double kRotor_kg = 1e-4;

class Tree {
 public:
  Tree() {
    text_.precision(17);
    text_
        << "<mujoco><compiler angle=\"radian\" boundmass=\"0\"/><size nconmax=\"1\" njmax=\"1\"/><worldbody>";
  }
  void open(const std::string& name, const std::string& where = "") {
    text_ << "<body name=\"" << name << "\" " << where << ">";
    ++depth_;
  }
  void joint(const std::string& name, const std::string& type, const std::string& axis, double armature = 0,
             double stiffness = 0, double damping = 0) {
    text_ << "<joint name=\"" << name << "\" type=\"" << type << "\" axis=\"" << axis << "\" armature=\""
          << armature << "\" stiffness=\"" << stiffness << "\" damping=\"" << damping << "\"/>";
  }
  void mass(double kg, const std::string& inertia = kPoint, double below_m = 0) {
    text_ << "<inertial pos=\"0 0 " << -below_m << "\" mass=\"" << kg << "\" diaginertia=\"" << inertia
          << "\"/>";
  }
  std::string finish(double gravity) {
    for (; depth_ > 0; --depth_) text_ << "</body>";
    text_ << "</worldbody><option gravity=\"0 0 " << -gravity
          << "\"><flag contact=\"disable\" constraint=\"disable\" energy=\"enable\"/></option></mujoco>";
    return text_.str();
  }

 private:
  std::ostringstream text_;
  int depth_ = 0;
};

std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

void add_jib(Tree& tree, const Physics& p) {
  const Drive& drive = p.rig.drive[kSlew];
  const bool flexible = p.load.jib_compliance_s2 > 0, gap = p.drive[kSlew].gap > 0;
  double jib = drive.inertia_kg;
  tree.open("slew_motor");
  if (flexible || gap) {
    const double share = flexible ? p.load.jib_share : p.drive[kSlew].far_share;
    tree.joint("slew", "hinge", "0 0 1", (1 - share) * drive.inertia_kg);
    tree.mass(kRotor_kg);
    jib *= share;
    tree.open("jib");
    const double c = p.load.jib_compliance_s2;
    tree.joint("slew_far", "hinge", "0 0 1", 0, flexible ? jib / c : 0,
               flexible ? 2 * p.load.jib_damping * jib / std::sqrt(c) : 0);
  } else {
    tree.joint("slew", "hinge", "0 0 1");
  }
  tree.mass(1, "1e-9 " + number(jib) + " " + number(jib));
}

void add_trolley(Tree& tree, const Physics& p) {
  const Drive& drive = p.rig.drive[kTrolley];
  const double rotor = drive.inertia_kg - p.rig.trolley_mass_kg;
  tree.open("trolley_motor");
  tree.joint("trolley", "slide", "1 0 0", rotor);
  if (p.drive[kTrolley].gap > 0) {
    tree.mass(kRotor_kg);
    tree.open("trolley");
    tree.joint("trolley_far", "slide", "1 0 0");
  }
  tree.mass(p.rig.trolley_mass_kg);
}

void add_load(Tree& tree, const Physics& p) {
  const double mass = p.rig.load_mass_kg + p.load.mass_kg, length = p.rig.cable_m + p.load.cable_m;
  const double lower = p.load.lower_share;
  const auto hinges = [&](const std::string& suffix) {
    const double damping = suffix.empty() ? 0 : 1e-4;
    tree.joint("radial" + suffix, "hinge", "0 1 0", 0, 0, damping);
    if (p.rig.tangential) tree.joint("tangential" + suffix, "hinge", "1 0 0", 0, 0, damping);
  };
  tree.open(lower > 0 ? "hook" : "load");
  hinges("");
  tree.mass((1 - lower) * mass, kPoint, length);
  if (lower <= 0) return;
  tree.open("load", "pos=\"0 0 " + number(-length) + "\"");
  hinges("_lower");
  tree.mass(lower * mass, kPoint, p.load.lower_m);
}

}  // namespace

std::string bodies_xml(const Physics& p) {
  Tree tree;
  if (p.rig.drive[kSlew].there) add_jib(tree, p);
  // A rotation by -a about y raises the far end; it turns with the jib.
  if (p.load.tilt_rad != 0) {
    tree.open("tilt", "euler=\"0 " + number(-p.load.tilt_rad) + " 0\"");
    tree.mass(kRotor_kg);
  }
  if (p.rig.drive[kTrolley].there) add_trolley(tree, p);
  if (p.rig.has_load()) add_load(tree, p);
  return tree.finish(p.rig.gravity_mps2);
}

}  // namespace mujoco_truth
