(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader: texts of certificates to the claims of Theorems.v, which the proven checkers decide. What it reads wrongly
   is proven of something else, so that this file, json.ml and exact.ml are trusted. Not proven, but checked as `exactvo
   audit` does: digests, that margins are the largest doubles, lengths. *)
open Checker
open Exact

exception Not_one

(* --- Lines: words and hexadecimal numbers --- *)
type reader = { mutable words : string list; mutable numbers : float list; mutable digest : int64 }

let next r = match r.words with w :: t -> r.words <- t; w | [] -> raise Not_one
let expect r w = if next r <> w then raise Not_one
let fnv r word =
  for i = 0 to 7 do
    let byte = Int64.logand (Int64.shift_right_logical word (8 * i)) 0xFFL in
    r.digest <- Int64.mul (Int64.logxor r.digest byte) 0x100000001B3L
  done
let number r =
  let w = next r in
  let x = if w = "inf" then infinity else match float_of_string_opt w with
    | Some x when Float.is_finite x && Printf.sprintf "%h" x = w -> x | _ -> raise Not_one in
  r.numbers <- x :: r.numbers; fnv r (Int64.bits_of_float x); x
let pair r = let x = number r in (x, number r)
let many r n f = List.init n (fun _ -> f r)
let counted r = let w = next r in
  match int_of_string_opt w with Some n when string_of_int n = w && n >= 0 && n <= List.length r.words -> n | _ -> raise Not_one
let reader words = { words; numbers = []; digest = 0xCBF29CE484222325L }
let finish r = expect r "digest"; let d = next r in
  if r.words <> [] || String.length d <> 16 then raise Not_one; d = Printf.sprintf "%016Lx" r.digest

let kinds = ["disc"; "segment"; "convex_polygon"; "ellipse"]
let shape_numbers r =
  let kind = next r in
  let rec index i = function [] -> raise Not_one | k :: t -> if k = kind then i else index (i + 1) t in
  let i = index 0 kinds in
  fnv r (Int64.of_int i);
  let n = match i with 0 -> 3 | 1 -> 4 | 3 -> 5 | _ -> let n = counted r in fnv r (Int64.of_int n); 2 * n in
  (i, many r n number)
let rec points q = function x :: y :: t -> (q x, q y) :: points q t | _ -> []
let shape q = function
  | 0, [x; y; r] -> Disc ((q x, q y), q r)
  | 3, [x; y; a; b; c] -> Ellipse ((q x, q y), q a, q b, q c)
  | _, xs -> Polygon (points q xs)

let above m = Int64.float_of_bits (Int64.succ (Int64.bits_of_float (m +. 0.)))
(* The margin must hold, and the next double above it must not. *)
let verdict r margin ok_digest holds =
  let m = if margin >= 0. && Float.is_finite margin then margin else -1. in
  let up = if m < 0. then 0. else above m in
  let q = fractions (List.filter Float.is_finite (up :: r.numbers)) in
  if m < 0. || not (holds q (q m)) || holds q (q up) then "wrong margin" else if ok_digest then "valid" else "altered"

let half_plane r =
  expect r "1";
  let s = shape_numbers r in
  let named w f = expect r w; f r in
  let p = named "position" pair in let radius = named "radius" number in let h = named "horizon" number in
  let u = named "velocity" pair in let n = named "normal" pair in let c = named "offset" number in
  let margin = named "margin" number in let ok = finish r in
  let infinite = List.length (List.filter (fun x -> not (Float.is_finite x)) r.numbers) in
  let disc_ok = match s with (0, [_; _; r]) -> r >= 0. | (2, []) -> false | _ -> true in
  if infinite > (if h = infinity then 1 else 0) || radius < 0. || not (h > 0.) || n = (0., 0.) || not disc_ok then "malformed"
  else verdict r margin ok (fun q m -> let at (x, y) = (q x, q y) in
    Checked.half_plane_holds { body = shape q s; body_velocity = at u; position = at p; radius = q radius;
      horizon = (if h = infinity then None else Some (q h)); normal = at n; offset = q c; margin = m })

let containment r =
  expect r "1"; expect r "ellipse";
  let e = many r 5 number in
  expect r "points";
  let n = counted r in
  fnv r (Int64.of_int n);
  let ps = many r (2 * n) number in
  expect r "margin";
  let margin = number r in let ok = finish r in
  if not (List.for_all Float.is_finite r.numbers) || n = 0 || List.nth e 2 = 0. || List.nth e 4 = 0. then "malformed"
  else verdict r margin ok (fun q m -> Checked.contains (shape q (3, e)) (points q ps) m)

let first_words = [("half-plane-certificate", half_plane); ("containment-certificate", containment)]
let begins text = List.exists (fun (w, _) -> String.starts_with ~prefix:(w ^ " ") text) first_words
let line text =
  let r = reader (String.split_on_char ' ' text) in
  try (match List.assoc_opt (next r) first_words with Some f -> f r | None -> raise Not_one) with Not_one -> "not a certificate"

(* --- Routes, in JSON --- *)
let rec floats acc = function
  | Json.Num x -> x :: acc | Json.Arr l -> List.fold_left floats acc l | Json.Obj m -> List.fold_left (fun a (_, v) -> floats a v) acc m
  | _ -> acc
let rec bits_needed_or most = function
  | Json.Num x -> bits_at_least most x
  | Json.Arr l -> List.fold_left bits_needed_or most l
  | Json.Obj m -> List.fold_left (fun most (_, v) -> bits_needed_or most v) most m
  | _ -> most
let bits_needed = bits_needed_or 0

(* A fraction must lie strictly between the doubles next to the one beside it. *)
let coordinate q x text =
  if text = "" then q x else begin
    let whole from upto =
      let digit i c = (c >= '0' && c <= '9') || (c = '-' && i = 0 && from = 0) in
      let t = String.sub text from (upto - from) in
      String.iteri (fun i c -> if not (digit i c) then raise Json.Bad) t;
      if t = "" || t = "-" then raise Json.Bad;
      try Whole.of_string t with Invalid_argument _ -> raise Json.Bad in
    let n = String.length text in
    let num, den = match String.index_opt text '/' with
      | Some k -> (whole 0 k, whole (k + 1) n) | None -> (whole 0 n, Whole.one) in
    (* num / den against y *)
    let against y = let y = rational y in Whole.compare (Whole.mul num y.qden) (Whole.mul y.qnum den) in
    let beyond y ok = not (Float.is_finite y) || ok (against y) in
    if Whole.sign den > 0 && beyond (Float.pred x) (fun c -> c > 0) && beyond (Float.succ x) (fun c -> c < 0) then { qnum = num; qden = den }
    else raise Json.Bad
  end
let point q = function
  | Json.Arr [Json.Num x; Json.Num y] -> (q x, q y)
  | Json.Arr [Json.Num x; Json.Num y; Json.Str a; Json.Str b] -> (coordinate q x a, coordinate q y b)
  | _ -> raise Json.Bad
let plain q = function Json.Arr [_; _] as p -> point q p | _ -> raise Json.Bad
let at_least n l = if List.length l >= n then l else raise Json.Bad
let obstacle q o =
  let ring n v = List.map (plain q) (at_least n (Json.arr v)) in
  match Json.find "polyline" o, Json.find "polygon" o with
  | Some l, None -> Wall (ring 2 l)
  | None, Some p -> Solid (ring 3 p :: (match Json.find "holes" o with Some h -> List.map (ring 3) (Json.arr h) | None -> []))
  | _ -> raise Json.Bad
(* One that stands still. *)
let disc q d = let centre = plain q (Json.get "centre" d) in { from = centre; to0 = centre; size = q Json.(num (get "radius" d)) }

type listed = { json : Json.t; bits : int; mutable ready : (int * obstacle list) option }
let obstacles : listed option ref = ref None
let ready l bits = match l.ready with
  | Some (b, os) when b >= bits -> (b, os)
  | _ -> let os = List.map (obstacle (over bits)) (Json.arr l.json) in l.ready <- Some (bits, os); (bits, os)

let is_route c = match Json.find "kind" c with Some (Json.Str k) -> List.mem k ["route"; "separated"; "blocked"] | _ -> false
let lengths_agree c ps =
  let rec sum acc = function
    | (a : point) :: ((b :: _) as t) ->
      sum (acc +. Float.hypot (difference (fst b) (fst a)) (difference (snd b) (snd a))) t
    | _ -> acc in
  let l = sum 0. ps and low = Json.(num (get "lower_bound" c)) in
  Float.abs (Json.(num (get "length" c)) -. l) <= Float.ldexp l (-40) && low >= 0. && low <= l *. (1. +. Float.ldexp 1. (-30))
let same (a : point) (b : point) =
  let equal (a : q) (b : q) = Whole.equal (Whole.mul a.qnum b.qden) (Whole.mul b.qnum a.qden) in equal (fst a) (fst b) && equal (snd a) (snd b)

let route c =
  try
    (match Json.find "obstacles" c with
     | Some json -> obstacles := Some { json; bits = bits_needed json; ready = None }
     | None -> ());
    let asked = match c with Json.Obj m -> Json.Obj (List.filter (fun (k, _) -> k <> "obstacles") m) | _ -> raise Json.Bad in
    match !obstacles with
    | None -> "no obstacles: neither in it nor in one before it"
    | Some l ->
      let bits, os = ready l (max l.bits (bits_needed asked)) in
      let q = over bits in
      let radius = Json.(num (get "radius" c)) and s = plain q (Json.get "start" c) and g = plain q (Json.get "goal" c) in
      if radius < 0. then raise Json.Bad;
      let proven = match Json.get "kind" c with
        | Json.Str "route" ->
          let ps = List.map (point q) (at_least 1 Json.(arr (get "points" c))) in
          let last = List.nth ps (List.length ps - 1) in
          same (List.hd ps) s && same last g && lengths_agree c ps
          && Checked.route os (q radius) (match ps with [p] -> [p; p] | _ -> ps)
        | Json.Str "separated" ->
          let joint j = { spot = point q (Json.get "point" j); obstacle_no = Json.(count (get "obstacle" j));
            edge_no = Json.(count (get "edge" j)); gap_follows = Json.(bool (get "gap" j)) } in
          Checked.chain os (q radius) s g (List.map joint Json.(arr (get "chain" c)))
        | _ ->
          let x = match Json.get "end" c with Json.Str "start" -> s | Json.Str "goal" -> g | _ -> raise Json.Bad in
          Checked.blocked os (q radius) x Json.(count (get "obstacle" c))
            (if Json.(bool (get "inside" c)) then None else Some Json.(count (get "edge" c))) in
      if proven then "valid" else if radius = 0. then "not covered: a point, radius 0" else "not proven"
  with Json.Bad -> "not a certificate"

(* --- Bodies that never meet, in JSON --- *)
exception Not_covered of string

let with_only known = function
  | Json.Obj members -> List.iter (fun (k, _) -> if not (List.mem k known) then raise (Not_covered ("a motion with \"" ^ k ^ "\""))) members
  | _ -> raise Json.Bad
let timed q = function Json.Arr [Json.Num t; Json.Num x; Json.Num y] -> (t, (q x, q y)) | _ -> raise Json.Bad
let parts_of q m =
  let part p =
    let r = Json.(num (get "radius" p)) in
    if r < 0. then raise Json.Bad;
    { corners = List.map (plain q) (at_least 1 Json.(arr (get "corners" p))); reach = q r } in
  List.map part (at_least 1 Json.(arr (get "body" m)))
let trip q m =
  let along leave arrive meant points =
    if arrive < leave then raise Json.Bad;
    { leave = q leave; arrive = q arrive; meant; points; parts = parts_of q m } in
  match Json.find "basis" m with
  | None ->
    with_only ["from"; "to"; "body"] m;
    let leave, start = timed q (Json.get "from" m) and arrive, goal = timed q (Json.get "to" m) in
    along leave arrive Bezier [start; goal]
  | Some basis ->
    with_only ["basis"; "start"; "end"; "points"; "body"] m;
    let meant = match basis with Json.Str "powers" -> Powers | Json.Str "bezier" -> Bezier | Json.Str "b-spline" -> Spline | _ -> raise Json.Bad in
    along Json.(num (get "start" m)) Json.(num (get "end" m)) meant (List.map (plain q) (at_least 1 Json.(arr (get "points" m))))
(* Its corners and its velocity are in the axes of the world, as they are at the start. *)
let drive q m =
  with_only ["from"; "until"; "velocity"; "turn"; "body"] m;
  let sets_out, place_then = timed q (Json.get "from" m) and halts = Json.(num (get "until" m)) in
  if halts < sets_out then raise Json.Bad;
  { sets_out = q sets_out; halts = q halts; place_then; heads = plain q (Json.get "velocity" m); turns = q Json.(num (get "turn" m)); body_parts = parts_of q m }

(* Directions have denominators of their own: a tiny component of one would lengthen all numbers. They have 56 bits at least, as
   lengths of directions are rounded up to whole units. *)
let rec bits_but_directions most = function
  | Json.Obj m -> List.fold_left (fun most (k, v) -> if String.equal k "direction" then most else bits_but_directions most v) most m
  | Json.Arr l -> List.fold_left bits_but_directions most l
  | v -> bits_needed_or most v
let clear c =
  try
    let q = over (bits_but_directions 0 c) in
    let separation s =
      let number k = q Json.(num (get k s)) and n = Json.get "direction" s in
      { part_no = Json.(count (get "part" s)); other_no = Json.(count (get "other" s)); since = number "from"; until = number "to";
        direction = plain (over (bits_needed_or 56 n)) n; width = number "margin" } in
    let a = Json.get "a" c and separations = List.map separation Json.(arr (get "separations" c)) in
    let proven = match Json.find "turn" a, Json.find "b" c, Json.find "obstacle" c with
      | None, Some b, None -> Checked.sweep (trip q a) (trip q b) separations
      | None, None, Some o -> Checked.sweep_past (trip q a) (obstacle q o) separations
      | Some _, None, Some o -> Checked.turn_past (drive q a) (obstacle q o) separations
      | Some _, Some _, None -> raise (Not_covered "two bodies of which one turns")
      | _ -> raise Json.Bad in
    if proven then "valid" else "not proven"
  with Json.Bad -> "not a certificate" | Not_covered what -> "not covered: " ^ what

(* Elsewhere than under "certificate" other objects have kinds too. *)
let is_certificate c = is_route c || Json.find "kind" c = Some (Json.Str "clear")
(* By its kind; nothing where it names none. *)
let of_kind c =
  match Json.find "kind" c with
  | Some (Json.Str "clear") -> Some (clear c)
  | Some (Json.Str kind) -> Some (if is_route c then route c else "not covered: a certificate of kind \"" ^ kind ^ "\"")
  | _ -> None
