(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: decisions of a recording. Half-planes against bodies at rest, and choices with multipliers. *)
open Checker
open Exact

type count = { mutable asked : int; mutable proven : int }
type t = { bodies : (int, Json.t) Hashtbl.t; half_planes : count; choices : count; mutable moving : int; mutable inexact : int }

let start () = { bodies = Hashtbl.create 64; half_planes = { asked = 0; proven = 0 }; choices = { asked = 0; proven = 0 }; moving = 0; inexact = 0 }
let ask count holds = count.asked <- count.asked + 1; if holds then count.proven <- count.proven + 1

let pair v = match Json.arr v with [x; y] -> (Json.num x, Json.num y) | _ -> raise Json.Bad
let number key v = Json.(num (get key v))
let is key v = Json.find key v = Some (Json.Bool true)

let body d b =
  match Json.find "shape" b with Some s -> Hashtbl.replace d.bodies Json.(count (get "number" b)) s | None -> ()

let shape at q s =
  match s with
  | Json.Obj ["disc", c] -> Disc (at (Json.get "center" c), q (number "radius" c))
  | Json.Obj ["ellipse", c] -> Ellipse (at (Json.get "center" c), q (number "l11" c), q (number "l21" c), q (number "l22" c))
  | Json.Obj [(("segment" | "polygon"), ps)] -> Polygon (List.map at (Json.arr ps))
  | _ -> raise Json.Bad

let half_plane robot radius c s =
  let anchor = match Json.find "anchor" robot with Some a -> a | None -> Json.get "position" robot in
  let horizon = match Json.get "time_horizon" c with Json.Null -> None | h -> Some (Json.num h) in
  let q = fractions (radius :: Option.value horizon ~default:0. :: List.concat_map (Certificates.floats []) [anchor; s; Json.get "normal" c; Json.get "offset" c]) in
  let at v = let x, y = pair v in (q x, q y) in
  Checked.half_plane_holds { body = shape at q s; body_velocity = (q 0., q 0.); position = at anchor; radius = q radius;
    horizon = Option.map q horizon; normal = at (Json.get "normal" c); offset = q (number "offset" c); margin = q 0. }

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
  let radius = number "radius" described and cs = match Json.find "constraints" r with Some c -> Json.arr c | None -> [] in
  List.iter (fun c -> match Hashtbl.find_opt d.bodies Json.(count (get "body" c)) with
    | Some s when is "certified" c -> ask d.half_planes (half_plane r radius c s)
    | _ -> d.moving <- d.moving + 1) cs;
  if Json.find "status" r = Some (Json.Str "optimal") && Json.find "multipliers" r = None then
    ask d.choices (choice r (number "max_speed" described) (Json.find "speed_bound" scenario <> Some (Json.Str "box")) cs)
  else d.inexact <- d.inexact + 1

let report d =
  let other n = if n = 0 then "" else Printf.sprintf "; %d others" n in
  Printf.printf "half-planes that are certified against bodies at rest: %d asked, %d proven%s\n" d.half_planes.asked d.half_planes.proven (other d.moving);
  Printf.printf "optimal choices with multipliers: %d asked, %d proven to be the best%s\n" d.choices.asked d.choices.proven (other d.inexact);
  d.half_planes.proven = d.half_planes.asked && d.choices.proven = d.choices.asked
