"""The parameters of each firmware, named, typed and ranged as theirs; speeds, heights and radii are set for indoors."""

from sim.autopilot.interface import Param


def _real(name: str, value: float, least: float, most: float) -> Param:
    return Param(name, value, False, least, most)


def _whole(name: str, value: int, least: int, most: int) -> Param:
    return Param(name, value, True, least, most)


def _fixed(name: str, value: int) -> Param:
    return Param(name, value, True, value, value, read_only=True)


SIMULATED = (
    _real("SIM_BAT_DRAIN", 0, 0, 86400),  # seconds from full to empty; 0: by the power drawn
    _real("SIM_BAT_REMAIN", -1, -1, 100),  # writing 0 to 100 sets the charge in percent
    _real("SIM_BATT_VOLTAGE", 0, 0, 60),  # pins the voltage; 0: by charge and current
)

ARDUPILOT_PARAMS: tuple[Param, ...] = (
    _fixed("SYSID_THISMAV", 1),
    _whole("SYSID_MYGCS", 255, 1, 255),
    _fixed("FRAME_CLASS", 1),
    _whole("ARMING_CHECK", 1, 0, 1 << 22),  # 0: none
    _real("BATT_ARM_VOLT", 14.2, 0, 60),
    _real("BATT_LOW_VOLT", 14.0, 0, 60),  # 0: off
    _real("BATT_CRT_VOLT", 13.6, 0, 60),
    _whole("BATT_LOW_TIMER", 10, 0, 120),
    _whole("BATT_FS_LOW_ACT", 2, 0, 7),  # 0 none, 1 land, 2 return, 3, 4 smart return, 5 terminate
    _whole("BATT_FS_CRT_ACT", 1, 0, 7),
    _whole("DISARM_DELAY", 10, 0, 127),
    _whole("FS_GCS_ENABLE", 0, 0, 7),  # 0 off, 1 return, 2 return unless in a mission, 3, 4 smart return, 5 land
    _real("FS_GCS_TIMEOUT", 5, 2, 120),
    _whole("FS_EKF_ACTION", 1, 0, 3),  # 0 report, 1 land, 2 altitude hold, 3 land from any mode
    _whole("FENCE_ENABLE", 0, 0, 1),
    _whole("FENCE_ACTION", 1, 0, 5),  # 0 report, 1 return, 2 land, 3 smart return, 4 brake, 5 smart return
    _whole("FENCE_TYPE", 7, 0, 15),  # bits: 1 altitude, 2 circle around home, 4 polygons
    _real("FENCE_ALT_MAX", 100, 0.5, 1000),
    _real("FENCE_RADIUS", 300, 0.5, 10000),
    _whole("FENCE_TOTAL", 0, 0, 1000),
    _real("GUID_TIMEOUT", 3, 0.1, 5),
    _real("WPNAV_SPEED", 200, 10, 2000),  # cm/s
    _real("WPNAV_SPEED_UP", 100, 10, 1000),
    _real("WPNAV_SPEED_DN", 75, 10, 500),
    _real("WPNAV_RADIUS", 10, 5, 1000),  # cm
    _whole("LAND_SPEED", 40, 20, 200),  # cm/s
    _whole("RTL_ALT", 150, 30, 300000),  # cm
    _whole("RTL_LOIT_TIME", 1000, 0, 60000),  # ms
    _whole("RTL_SPEED", 0, 0, 2000),  # cm/s; 0: WPNAV_SPEED
    *SIMULATED,
)

PX4_PARAMS: tuple[Param, ...] = (
    _fixed("MAV_SYS_ID", 1),
    _fixed("SYS_AUTOSTART", 10016),
    _whole("SYS_FAILURE_EN", 0, 0, 1),
    _real("COM_ARM_BAT_MIN", 0, 0, 0.9),
    _real("COM_DISARM_LAND", 2, -1, 20),  # 0 and less: never
    _real("COM_DISARM_PRFLT", 10, -1, 60),
    _real("COM_OF_LOSS_T", 1, 0, 60),
    _whole("COM_OBL_RC_ACT", 5, 0, 7),  # 0 position, 1 altitude, 2 manual, 3 return, 4 land, 5 hold, 6, 7 terminate
    _real("COM_FAIL_ACT_T", 5, 0, 25),  # seconds in hold before a failsafe acts
    _whole("COM_POS_FS_DELAY", 1, 1, 100),
    _whole("COM_LOW_BAT_ACT", 3, 0, 3),  # 0 warn, 2 land when critical, 3 return when critical and land in emergency
    _real("BAT_LOW_THR", 0.15, 0.05, 0.5),
    _real("BAT_CRIT_THR", 0.07, 0.03, 0.5),
    _real("BAT_EMERGEN_THR", 0.05, 0.01, 0.5),
    _whole("NAV_DLL_ACT", 2, 0, 6),  # 0 off, 1 hold, 2 return, 3 land, 5, 6 terminate
    _whole("COM_DL_LOSS_T", 10, 5, 300),
    _whole("GF_ACTION", 2, 0, 5),  # 0 off, 1 warn, 2 hold, 3 return, 4 terminate, 5 land
    _real("GF_MAX_HOR_DIST", 0, 0, 10000),  # 0: off
    _real("GF_MAX_VER_DIST", 0, 0, 10000),
    _real("MIS_TAKEOFF_ALT", 1.5, 0.2, 80),
    _real("MPC_XY_CRUISE", 2, 0.1, 20),
    _real("MPC_XY_VEL_MAX", 5, 0.1, 20),
    _real("MPC_Z_V_AUTO_UP", 1, 0.1, 8),
    _real("MPC_Z_V_AUTO_DN", 0.75, 0.1, 4),
    _real("MPC_LAND_SPEED", 0.4, 0.2, 2),
    _real("NAV_ACC_RAD", 0.1, 0.05, 200),
    _real("RTL_RETURN_ALT", 1.5, 0, 150),
    _real("RTL_LAND_DELAY", 0.5, -1, 300),  # negative: hover, do not land
    *SIMULATED,
)
