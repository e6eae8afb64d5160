(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: a robot on wheels (docs/guide/wheels.md) is judged as the disc about its reference point that
   holds it at every heading, and the stray of a twist: `wheels_sound`. That wheels do as they are told is not asked. *)
open Checker

let drive robot = match Json.find "kinematics" robot with
  | Some k when Json.find "type" k = Some (Json.Str "differential") -> Some k
  | _ -> None

let number key v = Json.(num (get key v))
let speed_and_acceleration k = (number "max_wheel_speed" k, number "max_wheel_acceleration" k)

let holds radius body ahead speed step =
  let q = Exact.fractions [radius; body; ahead; speed; step] in
  Checked.wheels_fit { body_reach = q body; ahead = q ahead; most_speed = q speed; time_step = q step } (q radius)

let as_disc step robot =
  match robot, drive robot with
  | Json.Obj members, Some k ->
    let body = number "radius" robot and ahead = number "reference" k and speed, _ = speed_and_acceleration k in
    let way = speed *. step in
    let stray = (1. +. 1e-12) *. (way *. way /. (4. *. ((2. *. ahead) -. way))) in
    let radius = (1. +. Float.ldexp 1. (-50)) *. (body +. ahead +. stray) in
    if not (holds radius body ahead speed step) then raise Json.Bad;
    let others = List.filter (fun (key, _) -> key <> "radius" && key <> "max_speed") members in
    Json.Obj (("radius", Json.Num radius) :: ("max_speed", Json.Num speed) :: others)
  | _ -> robot

(* The scenario with such discs in the place of robots on wheels. *)
let as_discs scenario = match scenario with
  | Json.Obj members ->
    let step = number "time_step" scenario in
    Json.Obj (List.map (function ("robots", Json.Arr robots) -> ("robots", Json.Arr (List.map (as_disc step) robots)) | m -> m) members)
  | _ -> raise Json.Bad
