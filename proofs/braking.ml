(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: rows of robots with an acceleration or on wheels, in each of which all could brake. *)
open Checker
open Exact

type t = { step : float; tau : float; scenario : Json.t; robots : Json.t list; mutable bits : int;
  mutable obstacles : obstacle list; mutable poles : (point * q) list; mutable widths : q list;
  in_time : bool; mutable latest : Json.t list; mutable was_outside : bool; count : Decisions.count }

let number key v = Json.(num (get key v))

(* With the denominator of a product of two numbers of the row (Braking.v). *)
let prepare b bits =
  let q = over (2 * bits) in
  let discs, others = Wheels.obstacles b.scenario in
  let pole o = let d = Certificates.disc q (Json.get "disc" o) in (d.from, d.size) in
  b.bits <- bits;
  b.obstacles <- List.map (Certificates.obstacle q) others;
  b.poles <- List.map pole discs;
  b.widths <- List.map (fun r -> q (number "radius" r)) b.robots

let acceleration scenario = match Json.find "acceleration" scenario with None | Some Json.Null -> None | Some a -> Some (number "max" a)

let share_of scenario = if Json.find "speed_bound" scenario = Some (Json.Str "box") then Float.sqrt 2. else 1.

(* The braking time that a scenario does not state is 1.1 V / A of the robot that is slowest to stop, and at least a step. Among
   movers of bounded speed it is no less than the steps in which that robot stands. *)
let usual_time scenario robots step =
  let movers = Decisions.meets_movers scenario in
  let in_steps speed a t = if movers then Float.max t (Decisions.stopping_steps speed a step *. step) else t in
  let of_robot t robot =
    let by speed a t = Float.max t (1.1 *. (speed /. a)) in
    let t = match acceleration scenario with Some a -> let speed = share_of scenario *. number "max_speed" robot in in_steps speed a (by speed a t) | None -> t in
    match Wheels.drive robot with Some k -> let speed, a = Wheels.speed_and_acceleration k in by speed a t | None -> t in
  List.fold_left of_robot step robots

(* The wheels of a robot have limits, and its velocity none: of what it takes nothing is claimed. *)
let most b robot had chosen =
  match acceleration b.scenario, Wheels.drive robot with
  | Some a, None -> a
  | _ ->
    let length (x, y) = Float.hypot x y and (x, y), (u, v) = had, chosen in
    let taken = 1.001 *. Float.max (length (u -. x, v -. y) /. b.step) (length chosen /. b.tau) in
    Float.ldexp (Float.ceil (Float.ldexp taken 16)) (-16)

(* tau A >= V, of velocities and of wheels. *)
let can_stop scenario robots tau =
  let stops speed a = Q.geq (Q.mul (Q.of_float tau) (Q.of_float a)) (Q.of_float speed) in
  List.for_all (fun robot -> match Wheels.drive robot, acceleration scenario with
    | Some k, _ -> let speed, a = Wheels.speed_and_acceleration k in stops speed a
    | None, Some a -> stops (share_of scenario *. number "max_speed" robot) a
    | None, None -> true) robots

let start scenario =
  let robots = Json.(arr (get "robots" scenario)) in
  if acceleration scenario = None && List.for_all (fun r -> Wheels.drive r = None) robots then None
  else begin
    let step = number "time_step" scenario in
    let tau = match Json.find "braking_time" scenario with Some (Json.Num t) -> t | _ -> usual_time scenario robots step in
    let b = { step; tau; scenario; robots; bits = 0; obstacles = []; poles = []; widths = []; in_time = can_stop scenario robots tau; latest = []; was_outside = false; count = { asked = 0; proven = 0 } } in
    prepare b (List.fold_left (fun m x -> max m (bits_of x)) (max 16 (Certificates.bits_needed scenario)) [step; tau]);
    Some b
  end

let ask b robots =
  let need = List.fold_left (fun m r -> List.fold_left (fun m key -> let x, y = Decisions.pair (Json.get key r) in max m (max (bits_of x) (bits_of y)))
      m ["position"; "velocity"; "chosen"]) b.bits robots in
  if need > b.bits then prepare b need;
  let q = over b.bits in
  let driver (described, its_radius) r =
    let at key = Decisions.pair (Json.get key r) in
    let exact (x, y) = (q x, q y) and had = at "velocity" and chosen = at "chosen" in
    { now_at = exact (at "position"); had = exact had; chosen = exact chosen; its_radius; its_most = q (most b described had chosen) } in
  let drivers = List.map2 driver (List.combine b.robots b.widths) robots in
  let at_rest d = { from = d.now_at; to0 = d.now_at; size = d.its_radius } in
  Decisions.ask b.count (b.in_time && Checked.brakes b.obstacles b.poles (q b.step) (q b.tau) drivers
    && (b.was_outside || Checked.starts b.obstacles (List.map at_rest drivers)))

(* Robots choose in each row but the last, after which none moves. *)
let row b ~outside robots =
  if b.latest <> [] then ask b b.latest;
  b.latest <- robots;
  b.was_outside <- outside

let report b =
  Printf.printf "rows but the last in which all could brake, alone and together: %d asked, %d proven%s\n" b.count.asked b.count.proven
    (if b.in_time then "" else "; the braking time is too short for a robot to stop");
  b.count.proven = b.count.asked
