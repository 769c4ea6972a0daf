# cmake --install: programs, documentation and system files, in FHS locations below the prefix. The programs find each
# other in their own folder and the configuration in the prefix's etc (deploy/tact/installed_config.hpp), so any prefix
# works, and the build folder too. Test equipment (tact-emu) is not installed. tact-bench, tact-certify and
# tact-reproduce have their own install rules (tests).
include(GNUInstallDirs)
install(TARGETS tact tact-prep tact-rt tact-record tact-replay RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TACT_GUI)
    install(TARGETS tact-gui RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(FILES desktop/tact.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
    install(FILES desktop/tact.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
    install(FILES desktop/tact.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
endif()
install(FILES tact.toml DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/tact)
install(FILES limits.conf DESTINATION ${CMAKE_INSTALL_SYSCONFDIR}/security/limits.d RENAME tact.conf)
install(FILES 60-tact.rules DESTINATION lib/udev/rules.d)
install(PROGRAMS can-up DESTINATION lib/tact)
file(READ tact-can@.service can_unit)
string(REPLACE /usr/local/lib/tact ${CMAKE_INSTALL_PREFIX}/lib/tact can_unit "${can_unit}")
file(CONFIGURE OUTPUT tact-can@.service CONTENT "${can_unit}" @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/tact-can@.service DESTINATION lib/systemd/system)
install(FILES units/tact-rt@.service units/tact-metrics.service DESTINATION lib/systemd/system)
install(FILES units/tact.sysusers DESTINATION lib/sysusers.d RENAME tact.conf)
install(FILES units/tact.tmpfiles DESTINATION lib/tmpfiles.d RENAME tact.conf)
install(DIRECTORY training/ DESTINATION ${CMAKE_INSTALL_DATADIR}/tact/training)
install(DIRECTORY monitoring/ DESTINATION ${CMAKE_INSTALL_DATADIR}/tact/monitoring)
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/ipc/record/RECORDING.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR})
