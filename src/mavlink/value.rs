//! The numbers that fields of messages can have, by their names in the message definitions.

/// Defines enums whose variants are numbers on the wire.
macro_rules! codes {
    ($($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $code:literal,)* })*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum $name { $($(#[$variant_doc])* $variant = $code,)* }

        impl $name {
            /// Returns the number on the wire.
            pub fn code(self) -> u8 {
                self as u8
            }

            /// Returns the value with a number, or `None` if there is none.
            pub fn from_code(code: u8) -> Option<Self> {
                [$(Self::$variant),*].into_iter().find(|value| value.code() == code)
            }
        }
    )*};
}

codes! {
    /// The answer to a command, `MAV_RESULT`.
    CommandResult {
        /// The command is carried out.
        Accepted = 0,
        /// The command is good, but not now.
        TemporarilyRejected = 1,
        /// The command is not allowed, or a parameter is wrong.
        Denied = 2,
        /// The command is not known.
        Unsupported = 3,
        /// The command was tried without success.
        Failed = 4,
        /// The command is being carried out; a further answer follows.
        InProgress = 5,
        /// The command was cancelled.
        Cancelled = 6,
        /// The command must be sent as `COMMAND_LONG`.
        LongOnly = 7,
        /// The command must be sent as `COMMAND_INT`.
        IntOnly = 8,
        /// The frame of the position is not supported.
        UnsupportedFrame = 9,
    }
    /// The end of a mission transfer, `MAV_MISSION_RESULT`.
    MissionResult {
        /// The mission is taken.
        Accepted = 0,
        /// An error without a number.
        Error = 1,
        /// The frame of an item is not supported, or cannot be used now.
        UnsupportedFrame = 2,
        /// The command of an item is not supported.
        Unsupported = 3,
        /// The mission has too many items.
        NoSpace = 4,
        /// An item has a value that is not allowed.
        Invalid = 5,
        /// Parameter 1 of an item is not allowed.
        InvalidParam1 = 6,
        /// Parameter 2 of an item is not allowed.
        InvalidParam2 = 7,
        /// Parameter 3 of an item is not allowed.
        InvalidParam3 = 8,
        /// Parameter 4 of an item is not allowed.
        InvalidParam4 = 9,
        /// The latitude of an item is not allowed.
        InvalidX = 10,
        /// The longitude of an item is not allowed.
        InvalidY = 11,
        /// The altitude of an item is not allowed.
        InvalidZ = 12,
        /// There is no such item.
        InvalidSequence = 13,
        /// The craft takes no mission now, or none at all.
        Denied = 14,
        /// The transfer was cancelled.
        Cancelled = 15,
    }
    /// The kind of the items of a mission transfer, `MAV_MISSION_TYPE`.
    MissionKind {
        /// Waypoints and commands.
        Mission = 0,
        /// Fences.
        Fence = 1,
        /// Rally points.
        Rally = 2,
        /// All kinds, to delete them.
        All = 255,
    }
    /// The importance of a text, `MAV_SEVERITY`.
    Severity {
        /// The system cannot be used.
        Emergency = 0,
        /// Act at once.
        Alert = 1,
        /// A failure.
        Critical = 2,
        /// An error, or something that was refused.
        Error = 3,
        /// May become an error.
        Warning = 4,
        /// Unusual, but no error.
        Notice = 5,
        /// Normal operation.
        Info = 6,
        /// For development.
        Debug = 7,
    }
    /// The state of the craft in relation to the ground, `MAV_LANDED_STATE`.
    LandedState {
        /// Not known.
        Undefined = 0,
        /// On the ground.
        OnGround = 1,
        /// In the air.
        InAir = 2,
        /// Taking off.
        TakingOff = 3,
        /// Landing.
        Landing = 4,
    }
    /// The state of the mission, `MISSION_STATE`.
    MissionState {
        /// Not known.
        Unknown = 0,
        /// The craft has no mission.
        NoMission = 1,
        /// The mission was not started.
        NotStarted = 2,
        /// The mission is flown.
        Active = 3,
        /// The mission is interrupted.
        Paused = 4,
        /// All items are done.
        Complete = 5,
    }
    /// The solution of the receiver, `GPS_FIX_TYPE`.
    GpsFix {
        /// There is no receiver.
        NoReceiver = 0,
        /// No position.
        NoFix = 1,
        /// A position without altitude.
        Fix2d = 2,
        /// A position with altitude.
        Fix3d = 3,
        /// With differential corrections.
        Differential = 4,
        /// Real-time kinematic, float.
        RtkFloat = 5,
        /// Real-time kinematic, fixed.
        RtkFixed = 6,
        /// Static.
        Static = 7,
        /// Precise point positioning.
        PrecisePoint = 8,
    }
    /// Modes that mean the same for all autopilots, `MAV_STANDARD_MODE`.
    StandardMode {
        /// A mode of one autopilot.
        NonStandard = 0,
        /// Holds the position without sticks.
        PositionHold = 1,
        /// Circles.
        Orbit = 2,
        /// Keeps altitude, heading and speed.
        Cruise = 3,
        /// Holds the altitude.
        AltitudeHold = 4,
        /// Returns or lands.
        SafeRecovery = 5,
        /// Flies the mission.
        Mission = 6,
        /// Lands.
        Land = 7,
        /// Takes off.
        TakeOff = 8,
    }
}

/// Commands, `MAV_CMD`.
#[allow(missing_docs, reason = "the names are those of the message definitions")]
pub mod command {
    pub const NAV_WAYPOINT: u16 = 16;
    pub const NAV_RETURN_TO_LAUNCH: u16 = 20;
    pub const NAV_LAND: u16 = 21;
    pub const NAV_TAKEOFF: u16 = 22;
    pub const DO_SET_MODE: u16 = 176;
    pub const DO_SET_HOME: u16 = 179;
    pub const DO_PAUSE_CONTINUE: u16 = 193;
    pub const DO_SET_MISSION_CURRENT: u16 = 224;
    pub const PREFLIGHT_REBOOT_SHUTDOWN: u16 = 246;
    pub const DO_SET_STANDARD_MODE: u16 = 262;
    pub const MISSION_START: u16 = 300;
    pub const COMPONENT_ARM_DISARM: u16 = 400;
    pub const GET_HOME_POSITION: u16 = 410;
    pub const GET_MESSAGE_INTERVAL: u16 = 510;
    pub const SET_MESSAGE_INTERVAL: u16 = 511;
    pub const REQUEST_MESSAGE: u16 = 512;
    pub const REQUEST_PROTOCOL_VERSION: u16 = 519;
    pub const REQUEST_AUTOPILOT_CAPABILITIES: u16 = 520;
}

/// Frames of positions, `MAV_FRAME`.
pub mod position_frame {
    /// Altitude above sea level.
    pub const GLOBAL: u8 = 0;
    /// No position.
    pub const MISSION: u8 = 2;
    /// Altitude above home.
    pub const GLOBAL_RELATIVE: u8 = 3;
    /// As [`GLOBAL`].
    pub const GLOBAL_INT: u8 = 5;
    /// As [`GLOBAL_RELATIVE`].
    pub const GLOBAL_RELATIVE_INT: u8 = 6;
    /// Altitude above the ground.
    pub const GLOBAL_TERRAIN: u8 = 10;
    /// As [`GLOBAL_TERRAIN`].
    pub const GLOBAL_TERRAIN_INT: u8 = 11;

    /// Returns `true` for a frame with latitude and longitude.
    pub fn is_global(frame: u8) -> bool {
        matches!(
            frame,
            GLOBAL | GLOBAL_RELATIVE | GLOBAL_INT | GLOBAL_RELATIVE_INT | GLOBAL_TERRAIN | GLOBAL_TERRAIN_INT
        )
    }

    /// Returns `true` for a frame with altitudes above sea level.
    pub fn is_amsl(frame: u8) -> bool {
        matches!(frame, GLOBAL | GLOBAL_INT)
    }
}

/// Bits of the base mode, `MAV_MODE_FLAG`.
pub mod mode_flag {
    /// The mode is the custom mode.
    pub const CUSTOM: u8 = 1;
    /// Flies a mission.
    pub const AUTO: u8 = 4;
    /// Flies to positions.
    pub const GUIDED: u8 = 8;
    /// Stabilises the attitude.
    pub const STABILISE: u8 = 16;
    /// Takes sticks.
    pub const MANUAL_INPUT: u8 = 64;
    /// The motors may turn.
    pub const ARMED: u8 = 128;
}

/// States of a system, `MAV_STATE`.
pub mod system_state {
    /// On the ground, ready.
    pub const STANDBY: u8 = 3;
    /// The motors may turn.
    pub const ACTIVE: u8 = 4;
    /// A failsafe.
    pub const CRITICAL: u8 = 5;
}

/// Kinds of systems, `MAV_TYPE`.
pub mod system_type {
    /// An aircraft with a fixed wing.
    pub const FIXED_WING: u8 = 1;
    /// A multirotor with four rotors.
    pub const QUADROTOR: u8 = 2;
    /// A ground station.
    pub const GROUND_STATION: u8 = 6;
    /// A ground vehicle.
    pub const ROVER: u8 = 10;
    /// A boat.
    pub const BOAT: u8 = 11;
    /// The first of the aircraft that take off vertically and fly with a wing.
    pub const FIRST_VTOL: u8 = 19;
    /// The last of them.
    pub const LAST_VTOL: u8 = 25;
}

/// Kinds of autopilots, `MAV_AUTOPILOT`.
pub mod autopilot {
    /// An autopilot without a number of its own.
    pub const GENERIC: u8 = 0;
    /// ArduPilot.
    pub const ARDUPILOT: u8 = 3;
    /// No autopilot, such as a ground station or a camera.
    pub const INVALID: u8 = 8;
    /// PX4.
    pub const PX4: u8 = 12;
}

/// Bits of the capabilities of an autopilot, `MAV_PROTOCOL_CAPABILITY`.
pub mod capability {
    /// Parameters are floating-point numbers.
    pub const PARAM_FLOAT: u64 = 2;
    /// Takes `MISSION_ITEM_INT`.
    pub const MISSION_INT: u64 = 4;
    /// Takes `COMMAND_INT`.
    pub const COMMAND_INT: u64 = 8;
    /// Speaks MAVLink 2.
    pub const MAVLINK2: u64 = 0x2000;
    /// Takes fences as missions.
    pub const MISSION_FENCE: u64 = 0x4000;
    /// Parameters are converted to floating-point numbers by value.
    pub const PARAM_C_CAST: u64 = 0x2_0000;
}

/// Bits of sensors and subsystems, `MAV_SYS_STATUS_SENSOR`.
pub mod sensor {
    /// Gyroscopes.
    pub const GYRO: u32 = 1;
    /// Accelerometers.
    pub const ACCELEROMETER: u32 = 2;
    /// Magnetometer.
    pub const MAGNETOMETER: u32 = 4;
    /// Barometer.
    pub const BAROMETER: u32 = 8;
    /// Satellite receiver.
    pub const GPS: u32 = 0x20;
    /// RC receiver.
    pub const RC_RECEIVER: u32 = 0x1_0000;
    /// Fence: a clear health bit is a breach.
    pub const FENCE: u32 = 0x10_0000;
    /// Battery.
    pub const BATTERY: u32 = 0x200_0000;
    /// The checks before arming pass.
    pub const READY_TO_ARM: u32 = 0x1000_0000;
}
