(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: decisions of a recording. Half-planes against bodies at rest, pairs of robots whose half-planes
   are opposite, and choices with multipliers. *)
open Checker
open Exact

type count = { mutable asked : int; mutable proven : int }
type t = { bodies : (int, Json.t) Hashtbl.t; half_planes : count; pairs : count; choices : count; mutable moving : int; mutable inexact : int }

let start () = { bodies = Hashtbl.create 64; half_planes = { asked = 0; proven = 0 }; pairs = { asked = 0; proven = 0 }; choices = { asked = 0; proven = 0 }; moving = 0; inexact = 0 }
let ask count holds = count.asked <- count.asked + 1; if holds then count.proven <- count.proven + 1

let pair v = match Json.arr v with [x; y] -> (Json.num x, Json.num y) | _ -> raise Json.Bad
let number key v = Json.(num (get key v))
let is key v = Json.find key v = Some (Json.Bool true)

let body d b = Hashtbl.replace d.bodies Json.(count (get "number" b)) b
let body_of d c = match Hashtbl.find_opt d.bodies Json.(count (get "body" c)) with Some b -> b | None -> raise Json.Bad
let shape_of d c = Json.find "shape" (body_of d c)
let other_of d c = match Json.find "kind" (body_of d c), Json.find "owners" (body_of d c) with
  | Some (Json.Str "robot"), Some (Json.Arr [k]) -> Json.count k | _ -> -1
let constraints r = match Json.find "constraints" r with Some c -> Json.arr c | None -> []
let anchor r = match Json.find "anchor" r with Some a -> a | None -> Json.get "position" r

let shape at q s =
  match s with
  | Json.Obj ["disc", c] -> Disc (at (Json.get "center" c), q (number "radius" c))
  | Json.Obj ["ellipse", c] -> Ellipse (at (Json.get "center" c), q (number "l11" c), q (number "l21" c), q (number "l22" c))
  | Json.Obj [(("segment" | "polygon"), ps)] -> Polygon (List.map at (Json.arr ps))
  | _ -> raise Json.Bad

(* The claim of a half-plane c of a robot; `judge` is given it with what turns doubles into fractions. *)
let claim robot radius c others judge =
  let horizon = match Json.get "time_horizon" c with Json.Null -> None | h -> Some (Json.num h) in
  let q = fractions (radius :: Option.value horizon ~default:0.
    :: List.concat_map (Certificates.floats []) (anchor robot :: Json.get "normal" c :: Json.get "offset" c :: others)) in
  let at v = let x, y = pair v in (q x, q y) in
  judge q at { body = Polygon []; body_velocity = (q 0., q 0.); position = at (anchor robot); radius = q radius;
    horizon = Option.map q horizon; normal = at (Json.get "normal" c); offset = q (number "offset" c); margin = q 0. }

let half_plane robot radius c s =
  claim robot radius c [s] (fun q at claim -> Checked.half_plane_holds { claim with body = shape at q s })

(* Each pair of robots whose half-planes against each other have opposite normals. *)
let pairs d radii robots =
  let opposite c e = let x, y = pair (Json.get "normal" c) and u, v = pair (Json.get "normal" e) in x = -. u && y = -. v in
  Array.iteri (fun i a -> List.iter (fun c ->
      let j = other_of d c in
      if j > i && j < Array.length robots && is "certified" c then
        match List.find_opt (fun e -> other_of d e = i && is "certified" e && opposite c e) (constraints robots.(j)) with
        | None -> ()
        | Some e ->
          let others = [anchor robots.(j); Json.Num radii.(j); Json.get "offset" e] in
          ask d.pairs (claim a radii.(i) c others (fun q at claim ->
            Checked.pair_holds claim (at (anchor robots.(j))) (q radii.(j)) (q (number "offset" e)))))
    (constraints a)) robots

(* The gap up to which the multipliers of a recording prove a choice: 2^-40 (V + |preferred|)^2, as for `audit`. *)
let choice robot speed is_disc cs =
  let px, py = pair (Json.get "preferred" robot) in
  let v = if is_disc then speed else Float.hypot speed speed in
  let gap = Float.ldexp ((v +. Float.hypot px py) ** 2.) (-40) in
  let multiplier c = match Json.find "multiplier" c with Some m -> Json.num m | None -> 0. in
  let bound = match Json.find "bound" robot with Some b -> List.map (fun p -> (Json.(str (get "part" p)), multiplier p)) (Json.arr b) | None -> [] in
  let q = fractions (speed :: gap :: List.map snd bound @ Certificates.floats [] (Json.Arr (Json.get "preferred" robot :: Json.get "chosen" robot
    :: List.concat_map (fun c -> [Json.get "normal" c; Json.get "offset" c; Json.Num (multiplier c)]) cs))) in
  let at v = let x, y = pair v in (q x, q y) in
  let row c = { row_normal = at (Json.get "normal" c); row_offset = q (number "offset" c); soft = not (is "hard" c) } in
  let side x y = { row_normal = (q x, q y); row_offset = q (-. speed); soft = false } in
  let sides = if is_disc then [] else ["box-right", side (-1.) 0.; "box-left", side 1. 0.; "box-top", side 0. (-1.); "box-bottom", side 0. 1.] in
  let of_part name = q (List.fold_left (fun m (n, x) -> if n = name then m +. x else m) 0. bound) in
  let limit = Some (q speed) in
  Checked.nearest
    { rows = List.map row cs @ List.map snd sides; disc = (if is_disc then limit else None);
      box_x = (if is_disc then None else limit); box_y = (if is_disc then None else limit); wish = at (Json.get "preferred" robot) }
    { velocity = at (Json.get "chosen" robot); gap = q gap; violation = q 0.;
      pull = List.map (fun c -> q (multiplier c)) cs @ List.map (fun (n, _) -> of_part n) sides;
      mu = (if is_disc then of_part "disc" else q 0.); against = [] }

let robot d scenario described r =
  let radius = number "radius" described and cs = constraints r in
  List.iter (fun c -> match shape_of d c with
    | Some s when is "certified" c -> ask d.half_planes (half_plane r radius c s)
    | _ -> d.moving <- d.moving + 1) cs;
  if Json.find "status" r = Some (Json.Str "optimal") && Json.find "multipliers" r = None then
    ask d.choices (choice r (number "max_speed" described) (Json.find "speed_bound" scenario <> Some (Json.Str "box")) cs)
  else d.inexact <- d.inexact + 1

let row d scenario robots =
  let described = Json.(arr (get "robots" scenario)) in
  List.iter2 (robot d scenario) described robots;
  pairs d (Array.of_list (List.map (number "radius") described)) (Array.of_list robots)

let report d =
  let other n = if n = 0 then "" else Printf.sprintf "; %d others" n in
  Printf.printf "half-planes that are certified against bodies at rest: %d asked, %d proven%s\n" d.half_planes.asked d.half_planes.proven
    (other (d.moving - 2 * d.pairs.asked));
  Printf.printf "pairs of robots with opposite half-planes: %d asked, %d proven not to collide until the horizon\n" d.pairs.asked d.pairs.proven;
  Printf.printf "optimal choices with multipliers: %d asked, %d proven to be the best%s\n" d.choices.asked d.choices.proven (other d.inexact);
  d.half_planes.proven = d.half_planes.asked && d.pairs.proven = d.pairs.asked && d.choices.proven = d.choices.asked
