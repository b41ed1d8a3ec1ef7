# What an installation has, and the Debian package of it: cmake --install, cpack (deploy/package).
include(GNUInstallDirs)

set(programs crane_cli crane_dashboard_process crane_plant_process crane_hardware_bridge_process crane_emulated_rig_process
  crane_trajectory_planner_process crane_tracking_process crane_anti_swing_process crane_friction_compensation_process
  crane_supervisor_process crane_twin_process crane_loop_process)
install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY deploy/rigs deploy/scenarios deploy/sweeps deploy/mappings deploy/foxglove DESTINATION ${CMAKE_INSTALL_DATADIR}/crane)
install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES deploy/systemd/crane.service deploy/systemd/crane-dashboard.service DESTINATION lib/systemd/system)

# Manual page and completions are printed by the program itself.
set(printed ${CMAKE_BINARY_DIR}/printed)
add_custom_target(crane_printed
  COMMAND ${CMAKE_COMMAND} -E make_directory ${printed}
  COMMAND crane_cli man > ${printed}/crane.1
  COMMAND crane_cli completion bash > ${printed}/crane
  COMMAND crane_cli completion zsh > ${printed}/_crane
  DEPENDS crane_cli VERBATIM)
add_custom_target(package_contents DEPENDS crane_printed ${programs})
install(FILES ${printed}/crane.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${printed}/crane DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${printed}/_crane DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME crane)
set(CPACK_PACKAGE_CONTACT "The crane project <crane@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "passwd, libcap2-bin")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${CMAKE_SOURCE_DIR}/deploy/debian/postinst;${CMAKE_SOURCE_DIR}/deploy/debian/prerm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)
include(CPack)
