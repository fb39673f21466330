//! The actions that work in every panel: the flight, time, the panels, the program, and the keys of lists.

use super::rows::actions;
use super::{EditAction, PanelAction};
use crate::ui::model::action::Context::{Always, Global, Lists};
use crate::ui::model::panel_table::Panel;

actions! {
    /// An action that a key or a command triggers.
    Action {
        Edit(EditAction),
        Panel(PanelAction),
        /// Show a panel.
        Show(Panel),
    }
    FLIGHT {
        Fly Global "flight.fly" "fly" "Fly the plan; asks if the craft has another (again: stops)" ["F"];
        Arm Global "flight.arm" "arm" "Arm or disarm by the ARM switch" ["a"];
        Throttle Global "flight.throttle" "throttle"
            "Throttle up and hold the place; in the air come down; else low" ["t"];
        Autopilot Global "flight.autopilot" "autopilot" "AUTOPILOT switch on or off: engage, disengage" ["g"];
        ReturnHome Global "flight.home" "home" "Return to home and land there (again: cancel it)" ["H"];
        GoTo Global "flight.go-to" "go to" "Go now to a waypoint of the craft's plan" ["G"];
        HoldHere Global "flight.hold" "hold here" "Hold this place and altitude" ["K"];
        Resume Global "flight.resume" "go on" "Go on with the plan after a hold" ["C"];
        CutRc Global "rc.cut" "cut RC" "Cut or restore the RC link of the sticks" ["x"];
        Upload Global "plan.upload" "upload" "Upload the plan to the craft" ["U"];
    }
    TIME {
        ResetCraft Global "craft.reset" "reset" "Put the craft back home, disarmed; plan and settings are kept" ["R"];
        AllowChanges Global "craft.allow-changes" "allow changes"
            "Allow changes to a remote flight controller until it disconnects" ["Y"];
        LookAhead Global "forecast.look-ahead" "look ahead" "How this flight would end" ["L"];
        WhatIf Global "forecast.what-if" "what if" "How it would end with a fault now; go or no-go" ["w"];
        WhereMay Global "forecast.where" "where" "Where a fault may be fatal: at every second of the plan" ["M"];
        GoNoGo Global "forecast.go" "go or no-go" "Go or no-go: a hundred noisy flights of the plan" ["ctrl-g"];
        Pause Global "sim.pause" "pause" "Pause, or go on" ["space"];
        Step Global "sim.step" "step" "Pause and advance by 10 ms, one navigator update" ["."];
        Tick Global "sim.tick" "tick" "Pause and advance by one tick" ["alt-."];
        EventBack Global "time.event-back" "event back" "Rewind by one event: every panel shows that instant" [","];
        EventForward Global "time.event" "next event" "On to the next event; at the end: fly until there is one" [";"];
        StateBack Global "time.state-back" "state back" "Rewind by one state change of the autopilot" ["{"];
        StateForward Global "time.state" "next state" "On to its next state; at the end: fly until there is one" ["}"];
        Earlier Global "time.earlier" "10 s back" "Rewind by 10 s" ["<"];
        Later Global "time.later" "10 s on" "Forward by 10 s in the recording" [">"];
        FlyOn Global "time.fly-on" "fly on" "Fly on from the instant shown; leave everything after it" ["b"];
        Newest Global "time.end" "to the end" "Back to the newest instant" ["e"];
        NextFlight Global "replay.next" "next flight" "The next flight of the replayed file" ["alt-right"];
        PreviousFlight Global "replay.previous" "flight before" "The flight before it in the replayed file" ["alt-left"];
        ShiftEarlier Global "replay.shift-earlier" "shift earlier"
            "Shift the second flight of a comparison by 0.1 s to earlier times" ["ctrl-left"];
        ShiftLater Global "replay.shift-later" "shift later"
            "Shift the second flight of a comparison by 0.1 s to later times" ["ctrl-right"];
        Slower Global "sim.slower" "slower" "Half the speed" ["["];
        Faster Global "sim.faster" "faster" "Twice the speed, in the end as fast as it goes" ["]"];
        RealTime Global "sim.real-time" "real time" "Back to real time" ["\\"];
    }
    SCREEN {
        Next Global "view.next" "next panel" "Focus the next panel" ["tab"];
        Previous Always "view.previous" "previous panel" "Focus the previous panel" ["shift-tab"];
        Zoom Global "view.zoom" "zoom" "The focused panel alone, or all again" ["z", "alt-z"];
        WriteScenario Global "flight.scenario" "write test"
            "Write the flight just flown as a scenario for `betadeck check`" ["T"];
        WriteRecording Global "flight.record" "write recording"
            "Write the recording of the flight so far, for `betadeck open`" ["ctrl-t"];
        WriteLog Global "flight.log" "write log" "Write the blackbox log of the flight so far" ["X"];
        Flights Global "app.flights" "flights" "The library of recorded flights: show, compare, delete" ["ctrl-f"];
        Layout Global "view.layout" "layout" "Resize and swap panels, choose a layout" ["ctrl-l"];
        Tutorial Global "app.tutorial" "tutorial" "Five steps through the first minutes, or end them" ["f12"];
        Help Global "app.help" "help" "The keys of this place" ["?"];
        CommandLine Global "app.command" "command" "A command by its name, such as :speed 4" [":"];
        Palette Always "app.palette" "palette" "Search all commands" ["ctrl-p"];
        Back Always "app.back" "back" "One step back: close, leave a text field or the CLI panel, end zoom" ["esc"];
        Quit Global "app.quit" "quit" "Quit (asks while the craft is armed or a plan has unsaved edits)" ["q"];
        Cancel Always "app.cancel" "cancel" "Cancel what is going on; twice within 2 s: quit" ["ctrl-c"];
        Redraw Always "app.redraw" "redraw" "Draw the whole screen again" ["alt-r"];
        Suspend Always "app.suspend" "suspend" "Back to the shell, `fg` returns" ["ctrl-z"];
    }
    LISTS {
        ScrollUp Lists "list.up" "up" "Scroll up" ["up", "k"];
        ScrollDown Lists "list.down" "down" "Scroll down" ["down", "j"];
        PageUp Lists "list.page-up" "page up" "Scroll up a page" ["pageup"];
        PageDown Lists "list.page-down" "page down" "Scroll down a page" ["pagedown"];
        Top Lists "list.top" "top" "To the first line" ["home"];
        Bottom Lists "list.bottom" "end" "To the last line" ["end"];
    }
}
