(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The checkers keep their promises: the kernel holds this module against Theorems.v. *)
From ExactVO Require Theorems HalfPlane Bodies Program Route Step Braking Sweep Turn Wheels.

Module Checked <: Theorems.Verifier.
  Definition half_plane_holds := HalfPlane.half_plane_holds.
  Definition half_plane_sound := HalfPlane.half_plane_sound.
  Definition pair_holds := HalfPlane.pair_holds.
  Definition pair_sound := HalfPlane.pair_sound.
  Definition contains := HalfPlane.contains.
  Definition contains_sound := HalfPlane.contains_sound.
  Definition hold := Bodies.hold.
  Definition hold_sound := Bodies.hold_sound.
  Definition nearest := Program.nearest.
  Definition farthest := Program.farthest.
  Definition least := Program.least.
  Definition nearest_sound := Program.nearest_sound.
  Definition farthest_sound := Program.farthest_sound.
  Definition least_sound := Program.least_sound.
  Definition pinned := Program.pinned.
  Definition pinned_sound := Program.pinned_sound.
  Definition contradicted := Program.contradicted.
  Definition contradicted_sound := Program.contradicted_sound.
  Definition route := Route.route.
  Definition route_sound := Route.route_sound.
  Definition chain := Route.chain.
  Definition chain_sound := Route.chain_sound.
  Definition blocked := Route.blocked.
  Definition blocked_sound := Route.blocked_sound.
  Definition starts := Step.starts.
  Definition starts_sound := Step.starts_sound.
  Definition step := Step.step.
  Definition step_sound := Step.step_sound.
  Definition run := Step.run.
  Definition run_sound := Step.run_sound.
  Definition brakes := Braking.brakes.
  Definition brakes_sound := Braking.brakes_sound.
  Definition sweep := Sweep.sweep.
  Definition sweep_sound := Sweep.sweep_sound.
  Definition sweep_past := Sweep.sweep_past.
  Definition sweep_past_sound := Sweep.sweep_past_sound.
  Definition turn_past := Turn.turn_past.
  Definition turn_past_sound := Turn.turn_past_sound.
  Definition wheels_fit := Wheels.wheels_fit.
  Definition wheels_sound := Wheels.wheels_sound.
End Checked.
