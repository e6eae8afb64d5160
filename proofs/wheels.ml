(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: a robot on wheels (docs/guide/wheels.md) is judged as the disc about its reference point that
   holds it at every heading, the stray of a twist (`wheels_sound`), and the tracking error that the scenario has;
   another robot as its disc and that error. That wheels and bodies do as they are told is not asked. *)
open Checker

let drive robot = match Json.find "kinematics" robot with
  | Some k when Json.find "type" k = Some (Json.Str "differential") -> Some k
  | _ -> None

let number key v = Json.(num (get key v))
let speed_and_acceleration k = (number "max_wheel_speed" k, number "max_wheel_acceleration" k)

let tracking scenario = match Json.find "uncertainty" scenario with
  | Some u -> let e = number "tracking" u in if e < 0. then raise Json.Bad else e
  | None -> 0.

(* The corners of a footprint, as seen from the axle. Only a robot on wheels has one, in place of a radius. *)
let corners robot = match Json.find "footprint" robot with
  | Some f ->
    let corner c = match Json.arr c with [x; y] -> Json.(num x, num y) | _ -> raise Json.Bad in
    let cs = List.map corner Json.(arr (get "polygon" f)) in
    if drive robot = None || Json.find "radius" robot <> None || List.length cs < 3 then raise Json.Bad;
    cs
  | None -> []

let disc_fits left body ahead speed step =
  let q = Exact.fractions [body; ahead; speed; step] in
  Checked.wheels_fit { body_reach = q body; ahead = q ahead; most_speed = q speed; time_step = q step } (Exact.of_q left)

(* No theorem is of corners: they are asked for here. *)
let corners_fit left cs ahead speed step =
  let q = Q.of_float in
  let way = Q.mul (q speed) (q step) in
  let room = Q.sub (Q.mul (q 2.) (q ahead)) way in
  let left = Q.sub left (Q.div (Q.mul way way) (Q.mul (q 4.) room)) in
  let is_within (x, y) = let x = Q.sub (q x) (q ahead) in Q.leq (Q.add (Q.mul x x) (Q.mul (q y) (q y))) (Q.mul left left) in
  Q.sign room > 0 && Q.sign left > 0 && List.for_all is_within cs

let holds radius robot ahead speed step tracking =
  let left = Q.sub (Q.of_float radius) (Q.of_float tracking) in
  match corners robot with
  | [] -> disc_fits left (number "radius" robot) ahead speed step
  | cs -> corners_fit left cs ahead speed step

let rounded_up = 1. +. Float.ldexp 1. (-50)

(* The radius of the first disc of a footprint's chain, against obstacles: slabs of a fifth of a box round the footprint
   and the reference point. (That of more discs, which turn, is not judged.) *)
let of_chain ahead more = function
  | [] -> []
  | cs ->
    let fold f get start = List.fold_left (fun m c -> f m (get c)) start cs in
    let slab = (fold Float.max fst ahead -. fold Float.min fst ahead) /. 5. in
    let half_width = fold Float.max (fun c -> Float.abs (snd c)) 0. in
    [("obstacle_radius", Json.Num ((1. +. 1e-12) *. (Float.hypot (0.5 *. slab) half_width +. more)))]

let has_footprint robot = Json.find "footprint" robot <> None

let as_disc step tracking robot =
  let corners = corners robot in
  match robot, drive robot with
  | Json.Obj members, Some k ->
    let ahead = number "reference" k and speed, _ = speed_and_acceleration k in
    let way = speed *. step in
    let stray = (1. +. 1e-12) *. (way *. way /. (4. *. ((2. *. ahead) -. way))) in
    let body = match corners with
      | [] -> number "radius" robot +. ahead
      | cs -> List.fold_left (fun most (x, y) -> Float.max most ((let x = x -. ahead in Float.sqrt ((x *. x) +. (y *. y))))) 0. cs in
    let radius = rounded_up *. (body +. stray +. tracking) in
    if not (holds radius robot ahead speed step tracking) then raise Json.Bad;
    let others = List.filter (fun (key, _) -> key <> "radius" && key <> "max_speed") members in
    Json.Obj (("radius", Json.Num radius) :: ("max_speed", Json.Num speed) :: of_chain ahead (stray +. tracking) corners @ others)
  | Json.Obj members, None when tracking > 0. ->
    let body = number "radius" robot in
    let radius = rounded_up *. (body +. tracking) in
    if Q.lt (Q.of_float radius) (Q.add (Q.of_float body) (Q.of_float tracking)) then raise Json.Bad;
    Json.Obj (("radius", Json.Num radius) :: List.remove_assoc "radius" members)
  | _ -> robot

(* Round ones, and others, that bodies are held against: none where some have footprints. *)
let obstacles scenario =
  if List.exists has_footprint Json.(arr (get "robots" scenario)) then ([], [])
  else List.partition (fun o -> Json.find "disc" o <> None) Json.(arr (get "obstacles" scenario))

(* The scenario with such discs in the place of robots on wheels. *)
let as_discs scenario = match scenario with
  | Json.Obj members ->
    let as_disc = as_disc (number "time_step" scenario) (tracking scenario) in
    Json.Obj (List.map (function ("robots", Json.Arr robots) -> ("robots", Json.Arr (List.map as_disc robots)) | m -> m) members)
  | _ -> raise Json.Bad
