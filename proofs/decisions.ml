(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: decisions of a recording. Half-planes against bodies at rest, pairs of robots whose half-planes
   are opposite, and choices with multipliers. *)
open Checker
open Exact

type count = { mutable asked : int; mutable proven : int }
type t = { bodies : (int, Json.t) Hashtbl.t; mutable named : Json.t list; held : count; mutable not_asked : int; half_planes : count; pairs : count; choices : count; mutable moving : int;
  mutable inexact : int }

let start () = { bodies = Hashtbl.create 64; named = []; held = { asked = 0; proven = 0 }; not_asked = 0; half_planes = { asked = 0; proven = 0 }; pairs = { asked = 0; proven = 0 }; choices = { asked = 0; proven = 0 }; moving = 0; inexact = 0 }
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

(* The bodies that a robot sees on the way to a goal: those of an obstacle hold it. A run among edges names those alone that
   it met, so that nothing is asked of it; nor is it of discs. *)
let goal_bodies d g = ignore (Json.arr (Json.get "bodies" g)); d.named <- g :: d.named
let stands_for k b = Json.find "kind" b = Some (Json.Str "enclosure") && List.exists (fun o -> Json.count o = k) Json.(arr (get "owners" b))
let holds k obstacle bodies =
  let shapes = List.filter_map (fun b -> if stands_for k b then Json.find "shape" b else None) bodies in
  let q = over (List.fold_left Certificates.bits_needed_or (Certificates.bits_needed obstacle) shapes) in
  let at v = let x, y = pair v in (q x, q y) in
  Checked.hold (List.map (shape at q) shapes) (Certificates.obstacle q obstacle)
let check_bodies d scenario =
  let some kind = Hashtbl.fold (fun _ b found -> found || (Json.find "kind" b = Some (Json.Str kind) && Json.find "owners" b <> Some (Json.Arr []))) d.bodies false in
  let edges = some "obstacle_edge" and seen = List.exists (fun g -> Json.get "bodies" g <> Json.Arr []) d.named in
  let before = ref (Json.Null, []) and obstacles = Json.(arr (get "obstacles" scenario)) in  (* robots mostly see the same *)
  if edges || not (some "enclosure" || seen) then d.not_asked <- List.length d.named * List.length obstacles
  else List.iter (fun g ->
    let names = Json.get "bodies" g in
    if fst !before <> names then begin
      let bodies = List.map (fun b -> match Hashtbl.find_opt d.bodies (Json.count b) with Some b -> b | None -> raise Json.Bad) (Json.arr names) in
      before := (names, List.mapi (fun k o -> if Json.find "disc" o = None then Some (holds k o bodies) else None) obstacles)
    end;
    List.iter (function Some holds -> ask d.held holds | None -> d.not_asked <- d.not_asked + 1) (snd !before)) (List.rev d.named)

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

(* A choice as recordings and the page of `view` state it: a line is (normal, offset, hard, its multiplier), a part of the
   speed bound (its name, its multiplier). *)
type chosen = { lines : ((float * float) * float * bool * float) list; disc : float option; box : (float * float) option;
  preferred : float * float; velocity : float * float; status : string; parts : (string * float) list }

let sides = [("box-right", (-1., 0.)); ("box-left", (1., 0.)); ("box-top", (0., -1.)); ("box-bottom", (0., 1.))]
let largest_speed c = Float.min (Option.value c.disc ~default:infinity) (match c.box with Some (x, y) -> Float.hypot x y | None -> infinity)

(* Multipliers in doubles prove a choice up to a gap of 2^-40 of its unit, as for `audit`: for an optimum (V + |preferred|)^2,
   for a least violation the larger of itself and V times the length of the longest normal that gives. *)
let is_best c =
  let infeasible = c.status = "infeasible" and optimal = c.status = "optimal" in
  let gives hard = if infeasible then hard else (not optimal && not hard) in
  let kept = if infeasible then List.filter (fun (_, _, hard, _) -> hard) c.lines else c.lines in
  let pulls (_, _, _, m) = m > 0. in
  let used = List.length (List.filter pulls c.lines) + List.length (List.filter (fun (n, m) -> m > 0. && (optimal || n <> "disc")) c.parts) in
  let exists = function "disc" -> c.disc <> None | n -> c.box <> None && List.mem_assoc n sides in
  let wrong = used > 3 || List.length (List.filter pulls kept) < List.length (List.filter pulls c.lines)
    || List.exists (fun (n, m) -> not (m >= 0.) || not (exists n)) c.parts || List.exists (fun (_, _, _, m) -> not (m >= 0.)) c.lines in
  let size (x, y) = Float.hypot x y in
  let given ((x, y), o, _, _) = let f = Q.of_float in
    Q.sub (f o) (Q.add (Q.mul (f x) (f (fst c.velocity))) (Q.mul (f y) (f (snd c.velocity)))) in
  let giving = List.filter (fun (_, _, hard, _) -> gives hard) kept in
  let most = List.fold_left (fun m l -> Q.max m (given l)) Q.zero giving in
  let length = List.fold_left (fun m ((n, _, _, _) as l) -> if pulls l then Float.max m (size n) else m) 0. giving in
  let unit = if optimal then (largest_speed c +. size c.preferred) ** 2. else Float.max (Q.to_float most) (largest_speed c *. length) in
  let gap = Float.ldexp unit (-40) in
  let both (x, y) = [x; y] in
  let q = fractions (gap :: List.concat_map (fun ((x, y), o, _, m) -> [x; y; o; m]) kept @ List.map snd c.parts
    @ Option.to_list c.disc @ List.concat_map both (Option.to_list c.box @ [c.preferred; c.velocity])) in
  let at (x, y) = (q x, q y) in
  let multiplier n = q (List.fold_left (fun m (name, x) -> if name = n then m +. x else m) 0. c.parts) in
  let side (n, (x, y)) = Option.map (fun (bx, by) -> ({ row_normal = at (x, y); row_offset = q (-. (if x <> 0. then bx else by)); soft = false }, multiplier n)) c.box in
  let bounds = List.filter_map side sides in
  let program = { rows = List.map (fun (n, o, hard, _) -> { row_normal = at n; row_offset = q o; soft = gives hard }) kept @ List.map fst bounds;
    disc = Option.map q c.disc; box_x = Option.map (fun b -> q (fst b)) c.box; box_y = Option.map (fun b -> q (snd b)) c.box; wish = at c.preferred } in
  let pull = List.map (fun (_, _, _, m) -> q m) kept @ List.map snd bounds in
  let answer = { velocity = at c.velocity; gap = q gap; violation = of_q most; pull; mu = (if optimal then multiplier "disc" else q 0.); against = pull } in
  not wrong && if optimal then Checked.nearest program answer else Checked.least program answer

(* From this speed a robot stands after so many steps of [t]: a millionth of its acceleration [a] is left to roundings. *)
let stopping_speed a t steps = steps *. ((1. -. 1e-6) *. a *. t)
let stopping_steps speed a t =
  let about = Float.max 1. (Float.ceil (speed /. stopping_speed a t 1.)) in
  if speed > stopping_speed a t about then about +. 1. else about

let meets_movers scenario = match Json.find "moving_obstacles" scenario with
  | Some (Json.Arr l) -> List.exists (fun mover -> Json.find "max_speed" mover <> None) l
  | _ -> false

(* Among movers of bounded speed no velocity is longer than one from which it stands after the steps that it says. *)
let stands_from scenario robot = match Json.find "stopping_steps" robot, Json.find "acceleration" scenario with
  | Some k, Some a when a <> Json.Null && meets_movers scenario -> Some (stopping_speed (number "max" a) (number "time_step" scenario) (Json.num k))
  | _ -> None

let choice robot speed is_disc within cs =
  let multiplier c = match Json.find "multiplier" c with Some m -> Json.num m | None -> 0. in
  let line c = (pair (Json.get "normal" c), number "offset" c, is "hard" c, multiplier c) in
  let bound = match Json.find "bound" robot with Some b -> Json.arr b | None -> [] in
  is_best { lines = List.map line cs; disc = (match within with Some w -> Some (if is_disc then Float.min speed w else w) | None -> if is_disc then Some speed else None); box = (if is_disc then None else Some (speed, speed));
    preferred = pair (Json.get "preferred" robot); velocity = pair (Json.get "chosen" robot); status = Json.(str (get "status" robot));
    parts = List.map (fun p -> (Json.(str (get "part" p)), multiplier p)) bound }

let robot d scenario described r =
  let radius = match Json.find "obstacle_radius" described with Some o -> Json.num o | None -> number "radius" described in
  let cs = constraints r in
  List.iter (fun c -> match shape_of d c with
    | Some s when is "certified" c -> ask d.half_planes (half_plane r radius c s)
    | _ -> d.moving <- d.moving + 1) cs;
  (* Half-planes of a user come in stages, which change what is hard: such choices are not judged. *)
  if Json.find "status" r <> Some (Json.Str "no-interior") && Json.find "status" r <> None && Json.find "multipliers" r = None
    && Json.find "own_stage" r = None then
    ask d.choices (choice r (number "max_speed" described) (Json.find "speed_bound" scenario <> Some (Json.Str "box")) (stands_from scenario r) cs)
  else d.inexact <- d.inexact + 1

let row d scenario robots =
  let described = Json.(arr (get "robots" scenario)) in
  List.iter2 (robot d scenario) described robots;
  pairs d (Array.of_list (List.map (number "radius") described)) (Array.of_list robots)

let report d =
  let other n = if n = 0 then "" else Printf.sprintf "; %d others" n in
  Printf.printf "obstacles, on the way of each robot to each goal: %d asked, %d proven to lie in the bodies that stand for them%s\n" d.held.asked d.held.proven
    (other d.not_asked);
  Printf.printf "half-planes that are certified against bodies at rest: %d asked, %d proven%s\n" d.half_planes.asked d.half_planes.proven
    (other (d.moving - 2 * d.pairs.asked));
  Printf.printf "pairs of robots with opposite half-planes: %d asked, %d proven not to collide until the horizon\n" d.pairs.asked d.pairs.proven;
  Printf.printf "choices with multipliers: %d asked, %d proven to be the best%s\n" d.choices.asked d.choices.proven (other d.inexact);
  d.held.proven = d.held.asked && d.half_planes.proven = d.half_planes.asked && d.pairs.proven = d.pairs.asked && d.choices.proven = d.choices.asked
