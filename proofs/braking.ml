(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: rows of robots with an acceleration, in each of which all could brake. *)
open Checker
open Exact

type t = { most : float; step : float; tau : float; scenario : Json.t; mutable bits : int;
  mutable obstacles : obstacle list; mutable poles : (point * q) list; mutable widths : q list;
  mutable latest : Json.t list; count : Decisions.count }

let number key v = Json.(num (get key v))

(* With the denominator of a product of two numbers of the row (Braking.v). *)
let prepare b bits =
  let q = over (2 * bits) in
  let discs, others = List.partition (fun o -> Json.find "disc" o <> None) Json.(arr (get "obstacles" b.scenario)) in
  let pole o = let d = Certificates.disc q (Json.get "disc" o) in (d.from, d.size) in
  b.bits <- bits;
  b.obstacles <- List.map (Certificates.obstacle q) others;
  b.poles <- List.map pole discs;
  b.widths <- List.map (fun r -> q (number "radius" r)) Json.(arr (get "robots" b.scenario))

(* The braking time that a scenario does not state is 1.1 V / A of the fastest robot, and at least a step. *)
let start scenario =
  match Json.find "acceleration" scenario with
  | None | Some Json.Null -> None
  | Some a ->
    let most = number "max" a and step = number "time_step" scenario in
    let share = if Json.find "speed_bound" scenario = Some (Json.Str "box") then Float.sqrt 2. else 1. in
    let usual = List.fold_left (fun t r -> Float.max t (1.1 *. (share *. number "max_speed" r /. most))) step Json.(arr (get "robots" scenario)) in
    let tau = match Json.find "braking_time" scenario with Some (Json.Num t) -> t | _ -> usual in
    let b = { most; step; tau; scenario; bits = 0; obstacles = []; poles = []; widths = []; latest = []; count = { asked = 0; proven = 0 } } in
    prepare b (List.fold_left (fun m x -> max m (bits_of x)) (Certificates.bits_needed scenario) [most; step; tau]);
    Some b

let ask b robots =
  let need = List.fold_left (fun m r -> List.fold_left (fun m key -> let x, y = Decisions.pair (Json.get key r) in max m (max (bits_of x) (bits_of y)))
      m ["position"; "velocity"; "chosen"]) b.bits robots in
  if need > b.bits then prepare b need;
  let q = over b.bits in
  let at key r = let x, y = Decisions.pair (Json.get key r) in (q x, q y) in
  let driver r its_radius = { now_at = at "position" r; had = at "velocity" r; chosen = at "chosen" r; its_radius } in
  Decisions.ask b.count (Checked.brakes b.obstacles b.poles (q b.step) (q b.tau) (q b.most) (List.map2 driver robots b.widths))

(* Robots choose in each row but the last, after which none moves. *)
let row b robots =
  if b.latest <> [] then ask b b.latest;
  b.latest <- robots

let report b =
  Printf.printf "rows in which all could brake within %g m/s^2, alone and together: %d asked, %d proven\n" b.most b.count.asked b.count.proven;
  b.count.proven = b.count.asked
